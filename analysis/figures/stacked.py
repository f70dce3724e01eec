"""Stacked confidence: how sure people were when they were right and when they were wrong."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import polars as pl
from numpy.typing import NDArray

from .drawn import Drawn
from .scales import CONFIDENCE, Scale
from .style import INK, Labels, arm_above, legend_above, panel
from .text import SMALL_POINTS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GUESSES = ("right", "wrong")
SHADES = ("#F1F5F9", "#D4E1EE", "#ABC6DF", "#7CA6CB", "#4C83B3", "#245E91", "#0B3A64")
"""From least to most sure: one hue that darkens evenly, so that grey print keeps the order."""

_ROWS = ((2.2, 1.6), (0.6, 0.0))
_HEIGHT = 0.5
_POINTS_ACROSS = 270
_POINTS_PER_CHARACTER = 6.5


def figure_confidence_levels(
    trials: pl.DataFrame, labels: Labels, scale: Scale = CONFIDENCE
) -> Drawn:
    """Show the share of each level of confidence among right and among wrong guesses per arm.

    `trials` has treated, correct and confidence, null where missing; a trial that lacks one of
    them is left out. A scale of other than seven ratings is cut into seven equal parts. Bars are
    100 % long; the number in a part counts its trials.
    """
    data = level_counts(trials, labels, scale)
    levels = data["confidence"].unique(maintain_order=True).to_list()
    note = f"{scale.title}. Number in a bar: trials, left out where it does not fit."
    with panel(3.6, note) as (figure, axes):
        for label, rows in zip(labels, _ROWS, strict=True):
            arm_above(axes, rows[0] + _HEIGHT / 2, label)
        ticks = []
        bars = data.partition_by("arm", "guess", maintain_order=True)
        for bar, y in zip(bars, np.ravel(_ROWS), strict=True):
            counts = bar["trials"].to_numpy()
            _bar(axes, y, counts)
            ticks.append(f"{bar['guess'][0]}\nn = {counts.sum():,}")
        for level, shade in zip(levels, SHADES, strict=True):
            axes.bar(0, 0, color=shade, edgecolor=INK, linewidth=0.5, label=level)
        axes.set_yticks(np.ravel(_ROWS), ticks)
        axes.set(xlim=(0, 100), ylim=(-0.3, 2.8), xlabel="Trials, %")
        axes.tick_params(left=False)
        axes.spines["left"].set_visible(False)
        axes.grid(visible=False)
        legend_above(figure, axes, ncols=len(levels), handlelength=1.2, columnspacing=1.4)
    seen = "; ".join(_in_words(bar) for bar in bars)
    return Drawn(figure, data, f"Stacked bars of {scale.in_words}: {seen}.")


def level_counts(trials: pl.DataFrame, labels: Labels, scale: Scale) -> pl.DataFrame:
    """Return arm, guess (right, wrong), confidence, trials and percent of the guess's trials."""
    known = trials.drop_nulls(["correct", "confidence"])
    treated, correct = (known[name].to_numpy() for name in ("treated", "correct"))
    part, names = _parts(known["confidence"].cast(pl.Float64).to_numpy(), scale)
    bar = 2 * ~treated + ~correct
    counts = np.bincount(bar * len(SHADES) + part, minlength=4 * len(SHADES))
    counts = counts.reshape(4, len(SHADES))
    percent = 100 * counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
    return pl.DataFrame(
        {
            "arm": np.repeat(labels, 2 * len(SHADES)),
            "guess": np.tile(np.repeat(GUESSES, len(SHADES)), 2),
            "confidence": names * 4,
            "trials": counts.ravel(),
            "percent": percent.ravel(),
        }
    )


def _parts(ratings: NDArray[np.float64], scale: Scale) -> tuple[NDArray[np.int64], list[str]]:
    """Return the number from 0 of each rating's part of the scale, and the names of the parts."""
    low, high = scale.range(0)
    if high - low + 1 == len(SHADES):
        return (ratings - low).round().astype(np.int64), [
            f"{low + i:g}" for i in range(len(SHADES))
        ]
    edges = np.linspace(low, high, len(SHADES) + 1)
    part = np.searchsorted(edges[1:-1], ratings, side="left")
    return part, [f"to {edge:.3g}" for edge in edges[1:]]


def _bar(axes: Axes, y: float, counts: NDArray[np.int64]) -> None:
    widths = 100 * counts / max(counts.sum(), 1)
    for count, width, end, shade in zip(counts, widths, widths.cumsum(), SHADES, strict=True):
        if not count:
            continue
        axes.barh(y, width, _HEIGHT, end - width, color=shade, edgecolor=INK, linewidth=0.5)
        if width / 100 * _POINTS_ACROSS > _POINTS_PER_CHARACTER * len(f"{count:,}"):
            axes.text(
                end - width / 2,
                y,
                f"{count:,}",
                ha="center",
                va="center",
                fontsize=SMALL_POINTS,
                color="white" if shade in SHADES[4:] else INK,
            )


def _in_words(bar: pl.DataFrame) -> str:
    arm, guess, n = bar["arm"][0], bar["guess"][0], int(bar["trials"].sum())
    if not n:
        return f"{arm}: no {guess} guess"
    surest = ", ".join(
        f"{row['percent']:.0f} % {row['confidence']}" for row in bar[-3:].iter_rows(named=True)
    )
    return f"{arm}, {guess} guesses: {surest}, n = {n:,} trials"
