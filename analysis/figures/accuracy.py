"""Accuracy along what people did: by how sure they were, and by when they stopped."""

from __future__ import annotations

from typing import TYPE_CHECKING

import polars as pl

from .drawn import Drawn
from .scales import CONFIDENCE, STOP_TIME, Scale
from .style import (
    COLOURS,
    FAINT,
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

    from ..statistics.calibration import AccuracyBy

_APART = 0.07
_INTERVAL = "whisker: 95 % interval, participants clustered"


def figure_calibration(
    accuracy: AccuracyBy, labels: Labels, chance: float, scale: Scale = CONFIDENCE
) -> Drawn:
    """Show the share of correct guesses at each level of confidence per arm, and blind guessing's.

    `accuracy` is by single ratings, `chance` a share from 0 to 1. Below the axis stand the trials
    at each level; a level that nobody chose has no mark.
    """
    data = _data(accuracy, labels)
    note = f"Mark: share of the trials with this rating; {_INTERVAL}."
    with panel(4.6, note) as (figure, axes):
        levels = [each.upper for each in accuracy.treatment]
        for arm, label in enumerate(labels):
            own = data.filter(pl.col("arm") == label)
            _draw(axes, own["upper"] + (2 * arm - 1) * _APART, own, arm, label)
        scale.mark(axes, "x")
        counts = (own["n_trials"] for own in data.partition_by("arm", maintain_order=True))
        counts_below(axes, "Trials", levels, *counts)
        _finish(axes, chance)
        legend_above(figure, axes)
    return Drawn(figure, data, _alt(data, scale.in_words, "", chance))


def figure_accuracy_by_time(accuracy: AccuracyBy, labels: Labels, chance: float) -> Drawn:
    """Show the share of correct guesses in bins of the stop time per arm, and blind guessing's.

    Each mark stands at the mean time of its trials, s; `chance` is a share from 0 to 1.
    """
    data = _data(accuracy, labels)
    note = (
        f"Mark: share of an arm's trials in a bin, at their mean time; {_INTERVAL}. "
        f"Bins: {len(accuracy.treatment)} quantile ranges of all stop times."
    )
    with panel(4.4, note) as (figure, axes):
        for arm, label in enumerate(labels):
            own = data.filter(pl.col("arm") == label)
            _draw(axes, own["mean"], own, arm, label)
        STOP_TIME.mark(axes, "x", float(data["mean"].drop_nulls().to_numpy().max(initial=0.0)))
        _finish(axes, chance)
        legend_above(figure, axes)
    return Drawn(figure, data, _alt(data, STOP_TIME.in_words, " s", chance))


def _data(accuracy: AccuracyBy, labels: Labels) -> pl.DataFrame:
    rows = [
        (
            label,
            each.lower,
            each.upper,
            each.mean,
            each.n,
            *(None if it is None else 100 * it for it in (each.share, each.low, each.high)),
        )
        for label, arm in zip(labels, (accuracy.treatment, accuracy.reference), strict=True)
        for each in arm
    ]
    numbers = ("lower", "upper", "mean", "n_trials", "percent", "low_percent", "high_percent")
    schema = {"arm": pl.String, **dict.fromkeys(numbers, pl.Float64), "n_trials": pl.Int64}
    return pl.DataFrame(rows, schema, orient="row")


def _draw(axes: Axes, x: pl.Series, own: pl.DataFrame, arm: int, label: str) -> None:
    """Draw one arm: marks joined by a line, and whiskers where the interval is defined."""
    name = wrapped(f"{in_sentence(label)}, n = {own['n_trials'].sum():,} trials", LEGEND_POINTS)
    shown = own.with_columns(x=x).drop_nulls("percent")
    axes.plot(
        shown["x"],
        shown["percent"],
        color=COLOURS[arm],
        linestyle=LINES[arm],
        linewidth=1.2,
        marker=MARKERS[arm],
        markersize=MARKER_POINTS[arm],
        label=name,
    )
    sure = shown.drop_nulls("low_percent")
    axes.vlines(sure["x"], sure["low_percent"], sure["high_percent"], color=COLOURS[arm])


def _finish(axes: Axes, chance: float) -> None:
    axes.axhline(
        100 * chance,
        color=FAINT,
        linestyle=":",
        label=f"guessing blindly, {100 * chance:.1f} %",
    )
    axes.set(ylim=(0, 103), yticks=range(0, 101, 20), ylabel="Correct guesses, %")


def _alt(data: pl.DataFrame, by: str, unit: str, chance: float) -> str:
    seen = []
    for own in data.partition_by("arm", maintain_order=True):
        marks = ", ".join(
            f"{row['percent']:.0f} % at {row['mean']:.3g}{unit}"
            for row in own.drop_nulls("percent").iter_rows(named=True)
        )
        seen.append(f"{own['arm'][0]} {marks}")
    return (
        f"Share of correct guesses by {by}: {'; '.join(seen)}. Guessing blindly gives "
        f"{100 * chance:.1f} %."
    )
