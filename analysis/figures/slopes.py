"""Paired scenario slopes: what the same scenario gave in both arms."""

from __future__ import annotations

from typing import TYPE_CHECKING

import polars as pl

from .drawn import Drawn
from .scales import Scale
from .style import COLOURS, FAINT, INK, LEGEND_POINTS, LINES, Labels, legend_above, panel
from .text import TEXT_POINTS, in_sentence, wrapped

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def figure_slopes(trials: pl.DataFrame, scale: Scale, labels: Labels) -> Drawn:
    """Show a line a scenario from its mean in the reference arm to its mean in the treatment arm.

    `trials` has scenario, treated and the scale's column, null where missing. Scenarios with
    values in one arm only are not drawn; the figure counts them. The bold line joins the arms'
    means over the scenarios drawn, each counted once.
    """
    means, unshared = scenario_means(trials, scale)
    left_out = (
        f" {unshared} scenario{'s' if unshared != 1 else ''} seen in one arm only left out."
        if unshared
        else ""
    )
    note = f"A thin line is a scenario, its mean over trials in each arm.{left_out}"
    with panel(4.6, note) as (figure, axes):
        kinds = _lines(axes, means, labels)
        if len(means):
            _overall(axes, means, scale)
        both = means.select("reference", "treatment").to_numpy()
        scale.mark(axes, "y", float(both.max(initial=0.0)))
        axes.set_xticks(
            (0, 1),
            [wrapped(label, 140, 3, TEXT_POINTS) for label in reversed(labels)],
            fontsize=TEXT_POINTS,
        )
        axes.set_xlim(-0.35, 1.35)
        axes.grid(visible=False)
        legend_above(figure, axes)
    return Drawn(figure, means, _alt(means, scale, labels, kinds) + left_out)


def scenario_means(trials: pl.DataFrame, scale: Scale) -> tuple[pl.DataFrame, int]:
    """Return the means of scenarios with values in both arms, and how many have them in one only.

    Columns: scenario, reference, treatment, n_reference, n_treatment, difference (treatment
    minus reference); sorted by scenario.
    """
    own = pl.col("value").filter
    means = (
        trials.select("scenario", "treated", value=scale.value)
        .drop_nulls("value")
        .group_by("scenario")
        .agg(
            reference=own(~pl.col("treated")).mean(),
            treatment=own("treated").mean(),
            n_reference=(~pl.col("treated")).sum(),
            n_treatment=pl.col("treated").sum(),
        )
        .with_columns(difference=pl.col("treatment") - pl.col("reference"))
        .sort("scenario")
    )
    shared = means.drop_nulls("difference")
    return shared, len(means) - len(shared)


def _lines(axes: Axes, means: pl.DataFrame, labels: Labels) -> list[tuple[str, int]]:
    """Draw the scenarios by direction; return each direction in words with its count."""
    kinds = []
    for words, sign, colour, line in (
        (f"higher with {in_sentence(labels[0])}", 1, COLOURS[0], LINES[0]),
        (f"higher with {in_sentence(labels[1])}", -1, COLOURS[1], LINES[1]),
        ("equal", 0, FAINT, ":"),
    ):
        own = means.filter(pl.col("difference").sign() == sign)
        axes.plot(
            (0, 1),
            own.select("reference", "treatment").to_numpy().T,
            line,
            color=colour,
            linewidth=1.1,
            marker=".",
            markersize=4,
        )
        counted = wrapped(f"{words}: {len(own)} of {len(means)} scenarios", LEGEND_POINTS)
        axes.plot([], [], line, color=colour, linewidth=1.6, label=counted)
        kinds.append((words, len(own)))
    return kinds


def _overall(axes: Axes, means: pl.DataFrame, scale: Scale) -> None:
    ends = _overall_means(means)
    axes.plot((0, 1), ends, color=INK, linewidth=3.5, marker="o", label="mean of the scenarios")
    for x, y, side in ((0, ends[0], -1), (1, ends[1], 1)):
        axes.annotate(
            scale.write(y),
            (x, y),
            xytext=(8 * side, 0),
            textcoords="offset points",
            ha="left" if side > 0 else "right",
            va="center",
            fontweight="bold",
        )


def _overall_means(means: pl.DataFrame) -> tuple[float, float]:
    """Return the mean over scenarios in the reference and in the treatment arm."""
    reference, treatment = means.select("reference", "treatment").to_numpy().mean(axis=0)
    return float(reference), float(treatment)


def _alt(means: pl.DataFrame, scale: Scale, labels: Labels, kinds: list[tuple[str, int]]) -> str:
    if means.is_empty():
        return "No scenario has values in both arms."
    directions = ", ".join(f"{words} in {count}" for words, count in kinds)
    ends = [scale.write(each) for each in _overall_means(means)]
    return (
        f"A line for each of {len(means)} scenarios joins its mean {scale.in_words} with "
        f"{labels[1]} and with {labels[0]}: {directions}. Mean of the scenarios: {ends[0]} with "
        f"{labels[1]}, {ends[1]} with {labels[0]}."
    )
