"""The exact distribution of sums of some of many whole numbers: what exact rank tests rest on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Scores = NDArray[np.int64]
"""Whole numbers, shape (N,)."""

_MOST_SCORES = 1_000
"""Up to here the number of subsets fits a float."""
_MOST_CELLS = 4_000_000
_MOST_ADDITIONS = 300_000_000


def feasible(scores: Scores, size: int) -> bool:
    """Whether `two_sided_p` of `size` chosen scores takes about a second and 100 MB at most."""
    if len(scores) > _MOST_SCORES:
        return False
    size = min(size, len(scores) - size)
    cells = (size + 1) * (int(_from_zero(scores)[-size:].sum()) + 1)
    return cells <= _MOST_CELLS and cells * len(scores) <= _MOST_ADDITIONS


def two_sided_p(scores: Scores, chosen: NDArray[np.bool_]) -> float:
    """Share of subsets of as many scores whose sum is at least as far from its mean.

    `chosen`, shape (N,), marks the observed subset. Source: Streitberg and Röhmel (1986), shift
    algorithm; two-sided as in R's exactRankTests::perm.test.
    """
    if 2 * chosen.sum() > len(scores):
        chosen = ~chosen  # as far from its mean, and quicker
    n, size, total = len(scores), int(chosen.sum()), int(scores.sum())
    sums, counts = distribution(scores, size)
    observed = abs(n * int(scores[chosen].sum()) - size * total)
    as_far = np.abs(n * sums - size * total) >= observed
    return float(counts[as_far].sum() / counts.sum())


def distribution(scores: Scores, size: int) -> tuple[Scores, NDArray[np.float64]]:
    """Return the sums that subsets of `size` > 0 scores can have, and how many subsets have each.

    The sums ascend in even steps, so some may have no subset. Source: Streitberg and Röhmel
    (1986).
    """
    ascending = _from_zero(scores)
    lowest = int(scores.min())
    step = _step(scores)
    subsets = np.zeros((size + 1, int(ascending[-size:].sum()) + 1))
    subsets[0, 0] = 1
    for score in ascending.tolist():
        subsets[1:, score:] += subsets[:-1, : subsets.shape[1] - score]
    sums = size * lowest + step * np.arange(subsets.shape[1], dtype=np.int64)
    return sums, subsets[size]


def _from_zero(scores: Scores) -> Scores:
    """Return the scores ascending, counted from the lowest in their largest common step."""
    ascending: Scores = np.sort(scores - scores.min()) // _step(scores)
    return ascending


def _step(scores: Scores) -> int:
    return int(np.gcd.reduce(scores - scores.min())) or 1
