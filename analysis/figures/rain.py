"""Rainclouds: how participants' means of a measure are distributed in both arms."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import polars as pl

from ..errors import EmptyArmError
from .drawn import Drawn
from .scales import Scale
from .style import COLOURS, INK, MARKERS, Labels, arm_above, boxes, panel

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

MOST_DOTS = 500
"""Dots drawn an arm; of more participants, those at evenly spaced ranks, so that the dots keep the
distribution."""

_CLOUD, _RAIN = (0.0, 0.42), (-0.42, -0.22)
_BOX, _BOX_HEIGHT = -0.11, 0.13
_ROWS = (1.15, 0.0)
_GOLDEN = (5**0.5 - 1) / 2


def figure_raincloud(trials: pl.DataFrame, scale: Scale, labels: Labels) -> Drawn:
    """Show participants' means per arm: histogram above, box plot, a dot a participant below.

    `trials` has participant, treated and the scale's column, null where missing. Participants
    without a value are left out. EmptyArmError if an arm has none.
    """
    means = participant_means(trials, scale, labels)
    arms = [means.filter(pl.col("arm") == label) for label in labels]
    values = [arm["mean"].to_numpy() for arm in arms]
    largest = max(float(each[-1]) for each in values)
    with panel(4.3, _note(values)) as (figure, axes):
        edges = scale.edges(largest)
        tallest = max(float(_heights(each, edges).max()) for each in values)
        for arm, base in enumerate(_ROWS):
            _cloud(axes, edges, _heights(values[arm], edges) / tallest, base, arm)
            _rain(axes, values[arm], base, arm)
            arm_above(axes, base + _CLOUD[1], labels[arm], _numbers(values[arm], scale))
        boxes(
            axes,
            values,
            [base + _BOX for base in _ROWS],
            orientation="horizontal",
            widths=_BOX_HEIGHT,
            showfliers=False,
        )
        scale.mark(axes, "x", largest)
        axes.set_ylim(_RAIN[0] - 0.05, _ROWS[0] + _CLOUD[1] + 0.32)
        axes.set_yticks([])
        axes.spines["left"].set_visible(False)
        axes.grid(axis="x")
    seen = "; ".join(
        f"{label}, {_numbers(each, scale)}" for label, each in zip(labels, values, strict=True)
    )
    return Drawn(figure, means, f"Raincloud of participants' {scale.in_words} in each arm: {seen}.")


def participant_means(trials: pl.DataFrame, scale: Scale, labels: Labels) -> pl.DataFrame:
    """Return arm, participant, n_trials and mean of all with a value, sorted by arm and mean."""
    means = (
        trials.select("participant", "treated", value=scale.value)
        .drop_nulls("value")
        .group_by("treated", "participant")
        .agg(n_trials=pl.len(), mean=pl.col("value").mean())
        .sort("mean", "participant")
    )
    arms = []
    for label, treated in zip(labels, (True, False), strict=True):
        own = means.filter(pl.col("treated") == treated)
        if own.is_empty():
            raise EmptyArmError(label, scale.column)
        arms.append(own.select(pl.lit(label).alias("arm"), "participant", "n_trials", "mean"))
    return pl.concat(arms)


def _heights(values: NDArray[np.float64], edges: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the share of values in each bin."""
    return np.histogram(values, edges)[0] / len(values)


def _cloud(
    axes: Axes, edges: NDArray[np.float64], heights: NDArray[np.float64], base: float, arm: int
) -> None:
    axes.stairs(
        base + _CLOUD[0] + heights * (_CLOUD[1] - _CLOUD[0]),
        edges,
        baseline=base + _CLOUD[0],
        fill=True,
        color=COLOURS[arm],
    )


def _rain(axes: Axes, values: NDArray[np.float64], base: float, arm: int) -> None:
    """Draw a dot a participant; its height means nothing, and keeps equal values apart."""
    drawn = np.linspace(0, len(values) - 1, min(len(values), MOST_DOTS)).round().astype(int)
    height = np.arange(len(drawn)) * _GOLDEN % 1
    axes.plot(
        values[drawn],
        base + _RAIN[0] + height * (_RAIN[1] - _RAIN[0]),
        MARKERS[arm],
        color=COLOURS[arm],
        markersize=3.2,
        markeredgecolor=INK,
        markeredgewidth=0.3,
        alpha=0.8,
    )


def _numbers(values: NDArray[np.float64], scale: Scale) -> str:
    mean, median = scale.write(float(values.mean())), scale.write(float(np.median(values)))
    return f"mean {mean}, median {median}, n = {len(values):,} participants"


def _note(values: list[NDArray[np.float64]]) -> str:
    if max(len(each) for each in values) <= MOST_DOTS:
        marks = "each participant"
    else:
        marks = f"at most {MOST_DOTS} participants an arm, at evenly spaced ranks"
    return (
        "Of participants' means: histogram; box of quartiles with thick median, dot at the mean, "
        f"whiskers to the last within 1.5 boxes; small marks: {marks}."
    )
