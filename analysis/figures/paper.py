"""The paper's three figures: correct guesses, time of prediction, confidence."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import polars as pl
from numpy.typing import NDArray

from .drawn import Drawn
from .scales import CONFIDENCE, Scale
from .style import COLOURS, INK, Labels, arms_below, boxes, panel

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..statistics.estimates import Mean, Share

_HEIGHT_INCHES = 4.0
_WIDTH = 0.55


def figure_correct(shares: Sequence[Share], labels: Labels) -> Drawn:
    """Percentage of correct guesses per arm from 0 to 100, with Wilson's 95 % interval."""
    data = pl.DataFrame(
        {
            "arm": labels,
            "correct": [each.count for each in shares],
            "n_trials": [each.n for each in shares],
            "percent": [100 * each.share for each in shares],
            "low_percent": [100 * each.low for each in shares],
            "high_percent": [100 * each.high for each in shares],
        }
    )
    with panel(_HEIGHT_INCHES, "Bar: share of trials; whisker: 95 % interval.") as (figure, axes):
        intervals = list(zip(data["low_percent"], data["high_percent"], strict=True))
        _bars(axes, data["percent"].to_list(), intervals, "{:.1f} %")
        axes.set_ylim(0, 100)
        axes.set_yticks(range(0, 101, 20))
        axes.set_ylabel("Correct guesses, %")
        arms_below(axes, labels, data["n_trials"].to_list())
    alt = "; ".join(
        f"{row['arm']} {row['percent']:.1f} % (95 % interval {row['low_percent']:.1f} to "
        f"{row['high_percent']:.1f} %, n = {row['n_trials']:,} trials)"
        for row in data.iter_rows(named=True)
    )
    return Drawn(figure, data, f"Bars of the share of correct guesses: {alt}.")


def figure_prediction_time(means: Sequence[Mean], labels: Labels) -> Drawn:
    """Mean time of prediction per arm from 0 s, with the t interval at 95 %.

    A single value has no interval, and no whisker.
    """
    data = pl.DataFrame(
        {
            "arm": labels,
            "n_trials": [each.n for each in means],
            "mean_s": [each.mean for each in means],
            "low_s": [each.low for each in means],
            "high_s": [each.high for each in means],
        },
        schema_overrides={"low_s": pl.Float64, "high_s": pl.Float64},
    )
    with panel(_HEIGHT_INCHES, "Bar: mean of trials; whisker: 95 % interval.") as (figure, axes):
        ends = data.select(pl.col("low_s", "high_s").fill_null(pl.col("mean_s")))
        intervals = list(ends.iter_rows())
        _bars(axes, data["mean_s"].to_list(), intervals, "{:.2f} s")
        axes.set_ylim(0, 1.12 * max(high for _, high in intervals) or 1)
        axes.locator_params("y", nbins=6, steps=[1, 2, 5, 10])
        axes.set_ylabel("Time of prediction, s")
        arms_below(axes, labels, data["n_trials"].to_list())
    seen = []
    for label, each in zip(labels, means, strict=True):
        interval = "not defined" if each.low is None else f"{each.low:.2f} to {each.high:.2f} s"
        seen.append(f"{label} {each.mean:.2f} s (95 % interval {interval}, n = {each.n:,} trials)")
    return Drawn(figure, data, f"Bars of the mean time of prediction: {'; '.join(seen)}.")


def figure_confidence(
    values: Sequence[NDArray[np.float64]], labels: Labels, scale: Scale = CONFIDENCE
) -> Drawn:
    """Box plot of confidence over its whole scale, from each arm's values in order, NaN left out.

    Box: quartiles; thick line: median; dot: mean; whiskers: to the last value within 1.5 box
    heights; rings: values beyond.
    """
    present = [each[~np.isnan(each)] for each in values]
    quartiles = [np.percentile(each, (25, 50, 75)) for each in present]
    data = pl.DataFrame(
        {
            "arm": labels,
            "n_trials": [len(each) for each in present],
            "mean": [float(each.mean()) for each in present],
            "median": [float(each[1]) for each in quartiles],
            "lower_quartile": [float(each[0]) for each in quartiles],
            "upper_quartile": [float(each[2]) for each in quartiles],
        }
    )
    note = (
        "Dot: mean of trials; thick line: median; box: quartiles; whiskers: to the last within "
        "1.5 boxes; rings: beyond."
    )
    with panel(_HEIGHT_INCHES, note) as (figure, axes):
        boxes(axes, present, range(len(present)), widths=_WIDTH)
        scale.mark(axes, "y")
        arms_below(axes, labels, data["n_trials"].to_list())
    alt = "; ".join(
        f"{row['arm']} mean {row['mean']:.2f}, median {row['median']:g}, quartiles "
        f"{row['lower_quartile']:g} and {row['upper_quartile']:g}, n = {row['n_trials']:,} trials"
        for row in data.iter_rows(named=True)
    )
    return Drawn(figure, data, f"Box plot of {scale.in_words}: {alt}.")


def _bars(
    axes: Axes, heights: list[float], intervals: list[tuple[float, float]], form: str
) -> None:
    places = range(len(heights))
    axes.bar(places, heights, _WIDTH, color=COLOURS)
    below = [height - low for height, (low, _) in zip(heights, intervals, strict=True)]
    above = [high - height for height, (_, high) in zip(heights, intervals, strict=True)]
    axes.errorbar(
        places, heights, yerr=[below, above], fmt="none", ecolor=INK, elinewidth=1.6, capsize=6
    )
    for place, height, (_, high) in zip(places, heights, intervals, strict=True):
        axes.annotate(
            form.format(height),
            (place, high),
            xytext=(0, 5),
            textcoords="offset points",
            ha="center",
            fontweight="bold",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5},
            annotation_clip=False,
        )
