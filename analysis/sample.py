"""Who is in the analysis: participants and trials per condition."""

from __future__ import annotations

from dataclasses import dataclass

import polars as pl

from .completion import completion
from .dataset import Dataset


@dataclass(frozen=True)
class ArmSize:
    """Size of one condition.

    `incomplete` participants have trials but did not finish; their trials are analysed.
    `without_trials` were dealt the condition and answered nothing, None if that is not known.
    """

    participants: int
    trials: int
    fewest_trials: int
    most_trials: int
    incomplete: int
    without_trials: int | None


@dataclass(frozen=True)
class Sample:
    """Sizes of both conditions by name, and what was taken as incomplete."""

    arms: dict[str, ArmSize]
    incomplete_means: str


def sample(data: Dataset) -> Sample:
    """Count participants and trials per condition."""
    found = completion(data.trials, data.participants, data.plan.trials_per_participant)
    arms = {arm: _arm_size(data, found.people, arm) for arm in data.arms.names}
    return Sample(arms, found.incomplete)


def _arm_size(data: Dataset, each: pl.DataFrame, arm: str) -> ArmSize:
    own = each.filter(pl.col("condition") == arm)
    trials = own["trials"].to_list()
    without = None
    if data.participants is not None:
        dealt = data.participants.filter(pl.col("condition") == arm)
        without = len(dealt.join(own, on="participant", how="anti"))
    return ArmSize(
        participants=len(own),
        trials=sum(trials),
        fewest_trials=min(trials),
        most_trials=max(trials),
        incomplete=len(own.filter(~pl.col("done"))),
        without_trials=without,
    )
