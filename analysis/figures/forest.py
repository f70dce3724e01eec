"""Forests: what all methods say about one effect, on one scale."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import floor, log10
from typing import TYPE_CHECKING

import polars as pl

from ..errors import AnalysisError
from ..wording import decimals_of_interval, format_p
from .drawn import Drawn
from .style import COLOURS, FAINT, INK, Labels, panel
from .text import SMALL_POINTS, TEXT_POINTS, in_sentence, wrapped

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..statistics.result import TestResult

_ROW_INCHES = 0.5
_REST_INCHES = 1.4
_MOST_DECIMALS = 4


def figure_forest(
    results: Mapping[str, TestResult], primary: str, effect: str, labels: Labels, alpha: float
) -> Drawn:
    """Show the estimate of `effect` and its 95 % interval by each method, the primary one marked.

    `results` by the name of the method; `primary` is one of these names, or another if none of
    them is. All must share their unit and their null value, which a line marks: AnalysisError if
    they do not. A method without an estimate says so; p has the digits that tell it from `alpha`.
    Ratios (null value 1) stand on a logarithmic axis.
    """
    from matplotlib.ticker import LogLocator, NullLocator

    unit, null = _shared_scale(results)
    data = _data(results, primary)
    decimals = _decimals(data)
    note = (
        f"Mark: estimate; bar: 95 % interval; dashed line: {null:g}, no difference; to its right: "
        f"more with {in_sentence(labels[0])}."
        + (" Diamond, bold: the plan's primary test." if data["primary"].any() else "")
    )
    with panel(_REST_INCHES + _ROW_INCHES * len(results), note) as (figure, axes):
        if null == 1:
            axes.set_xscale("log")
            axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axes.xaxis.set_major_formatter("{x:g}")
            axes.xaxis.set_minor_locator(NullLocator())
        axes.axvline(null, color=FAINT, linestyle="--", linewidth=1, zorder=0)
        axes.set_yticks(range(len(results)), [wrapped(name, 120, 3, bold=True) for name in results])
        for y, (name, result) in enumerate(results.items()):
            _draw(axes, y, result, is_primary=name == primary)
            _write(axes, y, (_estimate(result, decimals), *_p(result, alpha)), bold=name == primary)
            if name == primary:
                axes.get_yticklabels()[y].set_fontweight("bold")
        axes.set_ylim(len(results) - 0.4, -0.6)
        axes.set_xlabel(wrapped(f"{effect}, {unit}", 220, size=TEXT_POINTS))
        axes.margins(x=0.08)
        axes.tick_params(left=False, bottom=True)
        axes.spines["left"].set_visible(False)
        axes.grid(visible=False)
    seen = "; ".join(
        f"{name}{' (primary)' if name == primary else ''} "
        f"{_estimate(result, decimals)}, {', '.join(_p(result, alpha)) or 'no test'}"
        for name, result in results.items()
    )
    return Drawn(figure, data, f"Forest of {effect}, {unit}, null value {null:g}: {seen}.")


def _shared_scale(results: Mapping[str, TestResult]) -> tuple[str, float]:
    """Return the unit and the null value of all results."""
    scales = {(each.unit, each.null): name for name, each in results.items()}
    if len(scales) != 1:
        got = "; ".join(f"{unit}, null {null:g} ({name})" for (unit, null), name in scales.items())
        raise AnalysisError(
            f"forest: expected results of one unit and one null value, got {got or 'no result'}"
        )
    return next(iter(scales))


def _data(results: Mapping[str, TestResult], primary: str) -> pl.DataFrame:
    return pl.DataFrame(
        {
            "method": list(results),
            "primary": [name == primary for name in results],
            **{
                field: [getattr(each, field) for each in results.values()]
                for field in ("estimate", "low", "high", "p", "n", "of", "unit", "null")
            },
        },
        schema_overrides=dict.fromkeys(("estimate", "low", "high", "p"), pl.Float64),
    )


def _decimals(data: pl.DataFrame) -> int:
    """Return how many decimals give the largest estimate three digits, four for one next to 0."""
    largest = data["estimate"].abs().max()
    if not isinstance(largest, float) or not largest:
        return 2
    return min(_MOST_DECIMALS, max(0, 2 - floor(log10(largest))))


def _draw(axes: Axes, y: int, result: TestResult, *, is_primary: bool) -> None:
    colour, marker, size = (COLOURS[0], "D", 7) if is_primary else (INK, "o", 5)
    if result.low is not None and result.high is not None:
        axes.plot((result.low, result.high), (y, y), color=colour, linewidth=1.8)
    if result.estimate is not None:
        axes.plot(result.estimate, y, marker, color=colour, markersize=size)


def _write(axes: Axes, y: int, lines: Sequence[str], *, bold: bool) -> None:
    axes.annotate(
        "\n".join(lines),
        (1, y),
        xycoords=("axes fraction", "data"),
        xytext=(8, 0),
        textcoords="offset points",
        va="center",
        fontsize=SMALL_POINTS,
        fontweight="bold" if bold else "normal",
    )


def _estimate(result: TestResult, decimals: int) -> str:
    if result.estimate is None:
        return "not defined"
    if result.low is None or result.high is None:
        return f"{result.estimate:z.{decimals}f}, no interval"

    def write(value: float, more: int = 0, /) -> str:
        return f"{value:z.{decimals + more}f}"

    more = decimals_of_interval(result.low, result.high, result.null, write)
    low, high = write(result.low, more), write(result.high, more)
    return f"{write(result.estimate, more)} [{low}, {high}]"


def _p(result: TestResult, alpha: float) -> tuple[str, ...]:
    """Return p, nothing for an estimate that is not tested."""
    return () if result.p is None else (format_p(result.p, alpha=alpha),)
