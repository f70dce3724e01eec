"""Power by number of participants: simulated points and the curve through them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import polars as pl

from ..power import TARGETS, Power, PowerPoint
from ..wording import words_of_test
from .drawn import Drawn
from .style import COLOURS, FAINT, LINES, MARKERS, legend_above, panel

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_STEPS = 200
_APART_INCHES = 0.06
"""Between the dots of two tests, which were simulated with the same numbers of participants."""


def figure_power(power: Power) -> Drawn:
    """Show the power of each test, of at most two, by participants with Monte-Carlo intervals."""
    from matplotlib.ticker import MaxNLocator

    sizes = [point.participants for point in power.points]
    along = np.linspace(min(sizes), max(sizes), _STEPS)
    tests = power.question.tests
    note = (
        "Dot: simulated power; whisker: 95 % Monte-Carlo interval; line: curve through all dots; "
        f"dotted: {' and '.join(f'{100 * target:g} %' for target in TARGETS)}."
        f"{' Dots of the same number stand side by side.' if len(tests) > 1 else ''}"
    )
    with panel(3.9, note) as (figure, axes):
        for place, test in enumerate(tests):
            _dots(figure, axes, power.of_test(test), place)
            curve = 100 * power.curve(test).at(along)
            axes.plot(along, curve, LINES[place], color=COLOURS[place])
        for target in TARGETS:
            axes.axhline(100 * target, color=FAINT, linestyle=":", linewidth=1.2)
        axes.set_ylim(0, 102)
        axes.set_yticks(range(0, 101, 20))
        axes.xaxis.set_major_locator(MaxNLocator(steps=[1, 2, 5, 10], integer=True))
        axes.set_xlabel("Participants, both arms")
        axes.set_ylabel("Power, %")
        legend_above(figure, axes)
    return Drawn(figure, power_table(power), _alt(power))


def _dots(figure: Figure, axes: Axes, points: Sequence[PowerPoint], place: int) -> None:
    from matplotlib.transforms import ScaledTranslation

    shares = [point.result.rejected for point in points]
    centre = 100 * np.array([each.share for each in shares])
    ends = 100 * np.array([(each.low, each.high) for each in shares]).T
    aside = ScaledTranslation(_APART_INCHES * place, 0, figure.dpi_scale_trans)
    axes.errorbar(
        [point.participants for point in points],
        centre,
        # an interval may end a rounding error inside a share of 0 or 1
        yerr=np.maximum([centre - ends[0], ends[1] - centre], 0),
        fmt=MARKERS[place],
        color=COLOURS[place],
        capsize=3,
        label=words_of_test(points[0].result.test),
        transform=axes.transData + aside,
    )


def power_table(power: Power) -> pl.DataFrame:
    """Return the simulated points, a row for each number of participants and test."""
    return pl.DataFrame(
        [
            {
                "participants": point.participants,
                "test": point.result.test,
                "studies": point.result.rejected.n,
                "rejections": point.result.rejected.count,
                "undefined": point.result.undefined,
                "power": point.result.rejected.share,
                "low": point.result.rejected.low,
                "high": point.result.rejected.high,
            }
            for point in power.points
        ]
    )


def _alt(power: Power) -> str:
    def rises(test: str) -> str:
        points = power.of_test(test)
        first, last = (
            f"{100 * point.result.rejected.share:.1f} % with {point.participants}"
            for point in (points[0], points[-1])
        )
        return f"{words_of_test(test)} from {first} to {last} participants"

    return f"Power by participants: {'; '.join(map(rises, power.question.tests))}."
