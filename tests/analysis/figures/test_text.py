"""Texts fit by their printed width, whatever letters they are made of."""

from typing import Any

import pytest
from matplotlib.figure import Figure

from analysis.figures.text import in_sentence, wrapped


def printed_width(text: str, **look: Any) -> float:
    """Width in points, as matplotlib draws it."""
    figure = Figure(dpi=72)
    drawn = figure.text(0, 0, text, fontfamily="DejaVu Sans", parse_math=False, **look)
    figure.draw_without_rendering()
    return drawn.get_window_extent().width


@pytest.mark.parametrize(
    "text", ["word " * 60, "W" * 200, "i" * 400, "short", "Wide AND narrow, ill"]
)
@pytest.mark.parametrize("weight", ["normal", "bold"])
def test_a_text_stays_within_its_lines(text, weight):
    broken = wrapped(text, 140, lines=3, size=10, bold=weight == "bold")
    assert broken.count("\n") < 3
    # hinting on the screen moves letters by fractions of a point
    assert printed_width(broken, fontsize=10, fontweight=weight) <= 140 * 1.05


def test_a_text_that_fits_is_left_alone():
    assert wrapped("one two three", 200) == "one two three"


def test_what_does_not_fit_ends_in_an_ellipsis():
    assert wrapped("one two three four five six", 80, lines=1) == "one two three …"
    assert in_sentence("word " * 60).endswith(" …")
