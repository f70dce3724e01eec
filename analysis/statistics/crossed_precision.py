"""The precision matrix of crossed random effects, in which only scenarios are dense.

With F factors and one standard normal effect per level, N trials of weight w give the precision
H = I + S Z' diag(w) Z S: Z marks each trial's F levels, S is diagonal with the factors' standard
deviations. The first factor's block of H is diagonal, because a trial has one participant, so
everything is had from its Schur complement: O(N F^2 + P K^2 + K^3) for P levels of the first
factor and K of all others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .outcome import Clusters, Numbers


class Crossing:
    """Where the levels of N trials lie among the M effects of F factors.

    `positions`, of shape (F, N): which effects each trial has; `factor`, of shape (M,): whose
    effect each is. The first factor comes first.
    """

    def __init__(self, factors: Sequence[Clusters]) -> None:
        sizes = [int(codes.max()) + 1 for codes in factors]
        starts = np.concatenate([[0], np.cumsum(sizes)])
        self.positions = np.stack(factors) + starts[:-1, None]
        self.factor: NDArray[np.int64] = np.repeat(np.arange(len(sizes)), sizes)
        self.n_rows, self.n_columns = sizes[0], int(starts[-1]) - sizes[0]
        self.rows, self.columns = self.positions[0], self.positions[1:] - sizes[0]
        self._cross = self.rows * self.n_columns + self.columns
        self._dense = self.columns[:, None] * self.n_columns + self.columns

    def sums(self, values: Numbers) -> Numbers:
        """Return the sum of values, shape (N,), over the trials of each level, shape (M,)."""
        repeated = np.tile(values, len(self.positions))
        return _binned(self.positions, repeated, len(self.factor))

    def totals(self, effects: Numbers) -> Numbers:
        """Return the sum of effects, shape (M,), over the levels of each trial, shape (N,)."""
        total: Numbers = effects[self.positions].sum(axis=0)
        return total

    def precision(self, weights: Numbers, sds: Numbers) -> Precision:
        """Return H for weights of shape (N,) and standard deviations of shape (F,)."""
        P, K, others = self.n_rows, self.n_columns, len(self.columns)
        scale = sds[self.factor[P:]]
        diagonal = 1 + sds[0] ** 2 * _binned(self.rows, weights, P)
        cross = _binned(self._cross, np.tile(weights, others), P * K).reshape(P, K)
        cross *= sds[0] * scale
        dense = _binned(self._dense, np.tile(weights, others**2), K * K).reshape(K, K)
        dense *= np.outer(scale, scale)
        dense[np.diag_indices(K)] += 1
        whitened = cross / np.sqrt(diagonal)[:, None]
        dense -= whitened.T @ whitened
        log_determinant = float(np.log(diagonal).sum() + np.linalg.slogdet(dense).logabsdet)
        complement = np.linalg.inv(dense).astype(np.float64, copy=False)
        return Precision(self, diagonal, cross, complement, log_determinant)


@dataclass(frozen=True, eq=False)
class Precision:
    """H by blocks: `diagonal` of the first factor, shape (P,); `cross`, shape (P, K).

    `complement`, shape (K, K): the inverse of the other factors' Schur complement, which is their
    block of H^-1. `log_determinant` is that of H.
    """

    crossing: Crossing
    diagonal: Numbers
    cross: Numbers
    complement: Numbers
    log_determinant: float

    def solve(self, right: Numbers) -> Numbers:
        """Return the solution y, shape (M,), of H y = `right`."""
        P = len(self.diagonal)
        first = right[:P] / self.diagonal
        others = self.complement @ (right[P:] - first @ self.cross)
        return np.concatenate([first - self.cross @ others / self.diagonal, others])

    def covariances(self) -> Numbers:
        """Return the elements of H^-1 among the F effects of each trial, shape (F, F, N)."""
        rows, columns = self.crossing.rows, self.crossing.columns
        reduced = self.cross / self.diagonal[:, None]
        mixed = reduced @ self.complement
        found = np.empty((len(columns) + 1, len(columns) + 1, len(rows)))
        found[0, 0] = (1 / self.diagonal + np.einsum("pk,pk->p", mixed, reduced))[rows]
        found[0, 1:] = found[1:, 0] = -mixed[rows, columns]
        found[1:, 1:] = self.complement[columns[:, None], columns]
        return found


def _binned(places: Clusters, values: Numbers, size: int) -> Numbers:
    """Return the sum of values at each of `size` places; the stubs of bincount lose the type."""
    return np.bincount(places.ravel(), values, size).astype(np.float64, copy=False)
