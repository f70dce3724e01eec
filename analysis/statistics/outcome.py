"""One measure of all trials, with what groups them: what every method takes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import EmptyArmError

Numbers = NDArray[np.float64]
Clusters = NDArray[np.int64]

UNKNOWN = -1
"""The number of a scenario that nobody knows."""


@dataclass(frozen=True, eq=False)
class Outcome:
    """A measure of N trials, all arrays of shape (N,).

    `y` in `unit`, NaN where missing; `treated[i]`: whether trial i is of the treatment arm;
    `participant[i]`, `scenario[i]`: numbers from 0 of the clusters it belongs to. A trial that was
    never reached is of scenario `UNKNOWN`, which only the two-way tests take.
    """

    name: str
    unit: str
    y: Numbers
    treated: NDArray[np.bool_]
    participant: Clusters
    scenario: Clusters

    @property
    def n_missing(self) -> int:
        """How many trials lack the measure."""
        return int(np.isnan(self.y).sum())

    def present(self) -> Outcome:
        """The trials that have it, clusters numbered anew; EmptyArmError if an arm has none."""
        there = ~np.isnan(self.y)
        treated = self.treated[there]
        for arm, size in (("treatment", treated.sum()), ("reference", (~treated).sum())):
            if not size:
                raise EmptyArmError(arm, self.name)
        return Outcome(
            self.name,
            self.unit,
            self.y[there],
            treated,
            *(renumbered(each[there]) for each in (self.participant, self.scenario)),
        )


def renumbered(cluster: Clusters) -> Clusters:
    """Number clusters, shape (N,), without gaps; what is unknown stays so."""
    known = cluster != UNKNOWN
    numbered = np.full_like(cluster, UNKNOWN)
    numbered[known] = np.unique(cluster[known], return_inverse=True)[1]
    return numbered
