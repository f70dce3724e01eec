"""Trials made for the figures' tests, and what can be read off a figure."""

from collections.abc import Iterator

import numpy as np
import polars as pl
from matplotlib.figure import Figure
from matplotlib.text import Text

LABELS = ("PoLMDP", "optimal")
LONG_LABELS = (
    "A robot that shows its goal from the start",
    "Shortest-path robot, ties broken uniformly",
)


def trials(participants: int, per_participant: int = 10, scenarios: int = 37) -> pl.DataFrame:
    """Trials of a seeded study in which the arms take turns; the treatment is better."""
    rng = np.random.default_rng(5)
    n = participants * per_participant
    participant = np.repeat(np.arange(participants), per_participant)
    treated = participant % 2 == 0
    correct = rng.random(n) < 0.7 + 0.15 * treated
    stop_s = rng.gamma(6, 2, n).clip(max=20).round(2)
    return pl.DataFrame(
        {
            "participant": participant,
            "scenario": rng.integers(0, scenarios, n),
            "treated": treated,
            "correct": correct,
            "stop_time_s": stop_s,
            "length_s": np.full(n, 20.0),
            "prediction_time_s": np.where(correct, stop_s, 20.0),
            "confidence": (4 + 2 * correct + rng.normal(0, 1, n)).round().clip(1, 7).astype(int),
        }
    )


def all_alike(participants: int) -> pl.DataFrame:
    """Trials without any difference between them."""
    return trials(participants).with_columns(
        correct=True,
        stop_time_s=pl.lit(9.0),
        prediction_time_s=pl.lit(9.0),
        confidence=pl.lit(5),
    )


def texts(figure: Figure) -> Iterator[Text]:
    """Every text that is drawn; layout and positions are settled."""
    figure.draw_without_rendering()
    found = list(figure.texts)
    for legend in figure.legends:
        found += legend.get_texts()
    for axes in figure.axes:
        found += axes.texts
        if not axes.axison:
            continue
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            ticks = zip(axis.get_majorticklocs(), axis.get_majorticklabels(), strict=True)
            found += [axis.label, *(label for at, label in ticks if low <= at <= high)]
    yield from (text for text in found if text.get_text().strip())
