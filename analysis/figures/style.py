"""The look of all figures: one width, two sizes of text, two colours, labels that fit.

Every figure is as wide as `WIDTH_INCHES`, so that its smallest text is 6 pt in a column of 85 mm
and 12 pt over 170 mm. An arm has its colour, its marker and its line, and so keeps its look in
grey. Drawn without pyplot: nothing global is touched.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from .text import FONT, SMALL_POINTS, TEXT_POINTS, wrapped

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Labels = tuple[str, str]
"""What the treatment arm and the reference arm are called, of any length."""

COLOURS = ("#0072B2", "#E69F00")
"""Of the treatment and the reference arm: blue and orange of Okabe and Ito, told apart with every
kind of colour vision, and in grey."""
MARKERS = ("o", "s")
MARKER_POINTS = (6.5, 4.5)
"""So that a mark of the reference arm does not hide one of the treatment arm under it."""
GLYPHS = ("●", "■")
"""The markers as text."""
LINES = ("-", "--")

LEGEND_POINTS = 310
"""Width of a line of the legend."""

INK = "#222222"
FAINT = "#767676"
WIDTH_INCHES = 5.0

STYLE: dict[Any, Any] = {
    "font.family": FONT,
    "font.size": TEXT_POINTS,
    "xtick.labelsize": SMALL_POINTS,
    "ytick.labelsize": SMALL_POINTS,
    "legend.fontsize": SMALL_POINTS,
    "legend.frameon": False,
    "legend.borderpad": 0,
    "legend.handlelength": 2.5,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "text.color": INK,
    "text.parse_math": False,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.grid": True,
    "axes.grid.axis": "y",
    "grid.color": "#E3E3E3",
    "grid.linewidth": 0.8,
    "xtick.bottom": False,
    "svg.hashsalt": "goalguess",
    "svg.fonttype": "path",
}


@contextmanager
def panel(height_inches: float, note: str) -> Iterator[tuple[Figure, Axes]]:
    """Give an empty panel in our style, with `note`, how to read it, at its foot."""
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH_INCHES, height_inches), layout="constrained")
        figure.supxlabel(
            wrapped(note, 340, lines=6),
            x=0.02,
            ha="left",
            multialignment="left",
            fontsize=SMALL_POINTS,
            color="#555555",
        )
        yield figure, figure.add_subplot()


def arms_below(axes: Axes, labels: Labels, n: Sequence[int]) -> None:
    """Write each arm with its number of trials below the x axis, at 0 and 1."""
    names = [
        f"{wrapped(label, 140, 3, TEXT_POINTS)}\nn = {count:,} trials"
        for label, count in zip(labels, n, strict=True)
    ]
    axes.set_xticks(range(len(n)), names, fontsize=TEXT_POINTS)
    axes.set_xlim(-0.6, len(n) - 0.4)


def arm_above(axes: Axes, y: float, label: str, numbers: str = "") -> None:
    """Write an arm, and its `numbers` in a line below, across the row of data that ends at `y`."""
    at: dict[str, Any] = {
        "xy": (0, y),
        "xycoords": ("axes fraction", "data"),
        "textcoords": "offset points",
    }
    name = wrapped(label, 265, 1, TEXT_POINTS, bold=True)
    axes.annotate(name, xytext=(0, 15 if numbers else 3), fontweight="bold", **at)
    axes.annotate(numbers, xytext=(0, 3), fontsize=SMALL_POINTS, **at)


def counts_below(
    axes: Axes, heading: str, x: ArrayLike, treatment: ArrayLike, reference: ArrayLike
) -> None:
    """Write counts of both arms below the x axis and its label, each at its `x`."""
    xs, below = np.asarray(x, dtype=float), -34
    at: dict[str, Any] = {"textcoords": "offset points", "va": "top", "fontsize": SMALL_POINTS}
    corner = ("axes fraction", "axes fraction")
    axes.annotate(heading, (0, 0), xycoords=corner, xytext=(-24, below), color=FAINT, **at)
    for arm, counts in enumerate((treatment, reference)):
        below -= 13
        axes.annotate(
            GLYPHS[arm],
            (0, 0),
            xycoords=corner,
            xytext=(-30, below),
            ha="right",
            color=COLOURS[arm],
            **at,
        )
        for place, count in zip(xs, np.asarray(counts), strict=True):
            axes.annotate(
                f"{count:,}",
                (place, 0),
                xycoords=("data", "axes fraction"),
                xytext=(0, below),
                ha="center",
                **at,
            )


def legend_above(figure: Figure, axes: Axes, **how: Any) -> None:
    """Put the legend of what has a label above the panel, from its left; `how` is matplotlib's."""
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper left", **how)


def boxes(axes: Axes, values: Sequence[ArrayLike], positions: Sequence[float], **how: Any) -> None:
    """Draw a box plot an arm: quartiles, thick median, dot at the mean; `how` is matplotlib's."""
    drawn = axes.boxplot(
        values,
        positions=positions,
        patch_artist=True,
        showmeans=True,
        medianprops={"color": INK, "linewidth": 3.5, "solid_capstyle": "butt"},
        meanprops={
            "marker": "o",
            "markersize": 7,
            "markerfacecolor": "white",
            "markeredgecolor": INK,
            "markeredgewidth": 1.4,
        },
        flierprops={"marker": "o", "markersize": 4, "markeredgecolor": "#777777"},
        whiskerprops={"color": INK},
        capprops={"color": INK},
        boxprops={"edgecolor": INK},
        **how,
    )
    for colour, box in zip(COLOURS, drawn["boxes"], strict=True):
        box.set_facecolor(colour)
    for rings in drawn["fliers"]:
        # thousands of equal values would be as many rings in the file
        rings.set_data(*np.unique(rings.get_data(), axis=1))
