"""Texts that fit: broken into lines, or shortened, by the width they will have in print."""

from __future__ import annotations

import textwrap
from functools import cache

FONT = "DejaVu Sans"
TEXT_POINTS = 10
SMALL_POINTS = 9

_SENTENCE_POINTS = 240


@cache
def wrapped(
    text: str, points: float, lines: int = 2, size: float = SMALL_POINTS, *, bold: bool = False
) -> str:
    """Break a text into at most `lines` no wider than `points`; one that is too long ends in "…".

    Words wider than a line are broken.
    """
    for characters in range(int(points / size * 3), 1, -1):
        broken = textwrap.wrap(text, characters, max_lines=lines, placeholder=" …")
        if all(_width(line, size, bold=bold) <= points for line in broken):
            return "\n".join(broken)
    return "…"


def in_sentence(label: str) -> str:
    """Shorten a label to what a sentence of two or three lines has room for."""
    return wrapped(label, _SENTENCE_POINTS, lines=1)


@cache
def _width(line: str, size: float, *, bold: bool) -> float:
    """Return how many points wide a line is."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

    font = FontProperties(family=FONT, size=size, weight="bold" if bold else "normal")
    return float(text_to_path.get_text_width_height_descent(line, font, ismath=False)[0])
