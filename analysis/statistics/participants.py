"""Participants as the units: what each one's trials come to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .influence import cluster_count
from .outcome import Numbers, Outcome

_ROUNDING = 1e-10
"""Means that differ by this share of the largest are the same mean, its sum rounded differently."""


@dataclass(frozen=True, eq=False)
class Participants:
    """The P participants with a value of the measure, all arrays of shape (P,).

    `sums` of their values in the measure's unit, `trials` with a value, and whether they are of
    the treatment arm; `n_missing` participants more have no value.
    """

    sums: Numbers
    trials: NDArray[np.int64]
    treated: NDArray[np.bool_]
    n_missing: int

    @property
    def means(self) -> Numbers:
        """Mean of each, shape (P,); equal where only the order of their trials sets them apart."""
        means, of_participant = np.unique(self.sums / self.trials, return_inverse=True)
        step = np.diff(means, prepend=-np.inf) > _ROUNDING * np.abs(means).max()
        distinct: Numbers = means[step][np.cumsum(step) - 1][of_participant]
        return distinct


def by_participant(outcome: Outcome) -> Participants:
    """Sum up each participant's trials, each in one arm; EmptyArmError if an arm has no value."""
    data = outcome.present()
    trials = np.bincount(data.participant)
    return Participants(
        sums=np.bincount(data.participant, data.y).astype(np.float64),
        trials=trials,
        treated=np.bincount(data.participant, data.treated) > 0,
        n_missing=cluster_count(outcome.participant) - len(trials),
    )
