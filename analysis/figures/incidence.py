"""How many trials have ended by each time, by a correct and by a wrong stop."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import polars as pl

from ..wording import percent
from .drawn import Drawn
from .style import (
    COLOURS,
    LEGEND_POINTS,
    LINES,
    MARKER_POINTS,
    MARKERS,
    Labels,
    counts_below,
    legend_above,
    panel,
)
from .text import in_sentence, wrapped

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..statistics.outcome import Numbers
    from ..statistics.survival import ArmIncidence, Curve, Incidence

_TIMES = 5
_FEWEST_AT_RISK = 10
"""With fewer trials in an arm its curves hang on single trials."""


def figure_incidence(incidence: Incidence, labels: Labels, time: str = "Motion seen") -> Drawn:
    """Show the cumulative incidence of correct stops per arm with 95 % bands, of wrong ones dotted.

    Below the axis stand the trials at risk: not ended before. The axis ends where an arm has fewer
    than 10 of them, unless it has from the start. An arm of one participant has no band. `time`
    says what the axis counts.
    """
    incidence = _while_enough_at_risk(incidence)
    time_s, arms = incidence.time_s, (incidence.treatment, incidence.reference)
    marked = np.unique(np.searchsorted(time_s, np.linspace(0, time_s[-1], _TIMES)))
    note = (
        "Estimated share of trials stopped by then; a trial watched to its end leaves the count "
        "there. Band: 95 % interval at each time by itself, participants clustered."
    )
    with panel(5.0, note) as (figure, axes):
        for arm, (curves, label) in enumerate(zip(arms, labels, strict=True)):
            _band(axes, time_s, curves.correct, COLOURS[arm])
            name = in_sentence(label)
            for curve, line, stops in (
                (curves.correct, LINES[arm], "correct stops"),
                (curves.wrong, ":", "wrong stops"),
            ):
                axes.step(
                    time_s,
                    100 * curve.share,
                    line,
                    where="post",
                    color=COLOURS[arm],
                    label=wrapped(f"{name}: {stops}", LEGEND_POINTS),
                    marker=MARKERS[arm],
                    markevery=marked.tolist(),
                    markersize=MARKER_POINTS[arm],
                    clip_on=False,
                )
        axes.set(xlim=(0, float(time_s[-1]) or 1), ylim=(0, 100))
        axes.locator_params("x", nbins=6, steps=[1, 2, 5, 10])
        axes.set(xlabel=f"{time}, s", ylabel="Trials stopped, %")
        at_risk = (curves.at_risk[marked] for curves in arms)
        counts_below(axes, "Trials not ended before", time_s[marked], *at_risk)
        legend_above(figure, axes)
    return Drawn(figure, _data(incidence, labels), _alt(arms, labels, float(time_s[-1])))


def _while_enough_at_risk(incidence: Incidence) -> Incidence:
    """Leave out the times at which an arm has few trials at risk, unless it has from the start."""
    arms = incidence.treatment, incidence.reference
    times = int((np.minimum(*(arm.at_risk for arm in arms)) >= _FEWEST_AT_RISK).sum())
    # time 0 alone is no curve
    if times < 2:
        return incidence
    treatment, reference = (
        replace(
            arm,
            correct=_first(arm.correct, times),
            wrong=_first(arm.wrong, times),
            at_risk=arm.at_risk[:times],
        )
        for arm in arms
    )
    return replace(
        incidence, time_s=incidence.time_s[:times], treatment=treatment, reference=reference
    )


def _first(curve: Curve, times: int) -> Curve:
    """Return the beginning of a curve, so many times long."""
    there = {name: values for name, values in vars(curve).items() if values is not None}
    return replace(curve, **{name: values[:times] for name, values in there.items()})


def _band(axes: Axes, time_s: Numbers, curve: Curve, colour: str) -> None:
    if curve.low is None or curve.high is None:
        return
    low, high = 100 * curve.low, 100 * curve.high
    axes.fill_between(time_s, low, high, step="post", color=colour, alpha=0.22, linewidth=0)


def _data(incidence: Incidence, labels: Labels) -> pl.DataFrame:
    arms = (incidence.treatment, incidence.reference)
    return pl.concat(
        pl.DataFrame(
            {
                "arm": [label] * len(incidence.time_s),
                "stop": [stop] * len(incidence.time_s),
                "time_s": incidence.time_s,
                "percent": 100 * curve.share,
                "low_percent": None if curve.low is None else 100 * curve.low,
                "high_percent": None if curve.high is None else 100 * curve.high,
                "at_risk": curves.at_risk,
            },
            schema_overrides={"low_percent": pl.Float64, "high_percent": pl.Float64},
        )
        for label, curves in zip(labels, arms, strict=True)
        for stop, curve in (("correct", curves.correct), ("wrong", curves.wrong))
    )


def _alt(arms: tuple[ArmIncidence, ArmIncidence], labels: Labels, end_s: float) -> str:
    seen = "; ".join(
        f"{label} {percent(curves.correct.share[-1])} correct and "
        f"{percent(curves.wrong.share[-1])} wrong stops"
        for label, curves in zip(labels, arms, strict=True)
    )
    counted = "; ".join(
        f"{label} {percent(curves.n_correct / curves.n)} correct and "
        f"{percent(curves.n_wrong / curves.n)} wrong stops, n = {curves.n:,} trials"
        for label, curves in zip(labels, arms, strict=True)
    )
    return (
        "Curves of the estimated share of trials stopped by each time, where a trial watched to "
        f"its end leaves the count there; by {end_s:.1f} s: {seen}. Counted, of all trials, "
        f"whenever they ended: {counted}."
    )
