"""How light colours are and how far apart, for arrays of sRGB values from 0 to 1."""

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]

TO_XYZ = np.array(
    [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
)  # rows X, Y, Z; the white of sRGB is their sum
TO_LAB = np.array([[0, 116, 0], [500, -500, 0], [0, 200, -200]])


def linear(colours: Values) -> Values:
    """Light, in proportion: the sRGB curve undone."""
    light: Values = np.where(
        colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4
    )
    return light


def luminance(colours: Values) -> Values:
    """Relative luminance as WCAG defines it."""
    bright: Values = linear(colours) @ TO_XYZ[1]
    return bright


def contrast(one: float, other: float) -> float:
    """WCAG's contrast ratio of two luminances."""
    return (max(one, other) + 0.05) / (min(one, other) + 0.05)


def difference(one: Values, other: Values) -> float:
    """CIE 1976 colour difference; 2.3 is just noticeable."""
    return float(np.linalg.norm(_lab(one) - _lab(other)))


def _lab(colour: Values) -> Values:
    xyz = TO_XYZ @ linear(colour) / TO_XYZ.sum(axis=1)
    curved = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    lab: Values = TO_LAB @ curved
    return lab
