"""Order statistics of all differences between two samples, without making all differences."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .outcome import Numbers

_MOST_LISTED = 1_000_000
"""Pairs whose differences are listed and sorted; more are narrowed down by halving first.

At least as many as one difference can have pairs, or halving would not end: the smaller sample's
number of different values.
"""


@dataclass(frozen=True, eq=False)
class Pairwise:
    """The differences x - y of all pairs of two samples, equal values taken together.

    `x`, `y` ascend without ties; `times_x`, `times_y` say how often each occurs.
    """

    x: Numbers
    y: Numbers
    times_x: NDArray[np.int64]
    times_y: NDArray[np.int64]

    @classmethod
    def of(cls, x: Numbers, y: Numbers) -> Pairwise:
        """Take in two samples, of at least one value each, without missing values."""
        (x, times_x), (y, times_y) = (np.unique(each, return_counts=True) for each in (x, y))
        return cls(x, y, times_x, times_y)

    def smallest(self, rank: int) -> float:
        """Return the `rank`-th smallest difference, 1 the smallest, in O(n log n) time.

        Source: halving as in Monahan (1984), ACM Transactions on Mathematical Software 10.
        """
        first = np.zeros(len(self.x), np.int64)
        last = np.full(len(self.x), len(self.y))
        low, high = self.x[0] - self.y[-1], self.x[-1] - self.y[0]
        listed = max(_MOST_LISTED, len(self.y))
        while (last - first).sum() > listed and low < (middle := (low + high) / 2) < high:
            # for each x the y that make differences up to the middle are the larger ones
            split = np.searchsorted(self.y, self.x - middle)
            if self._pairs_from(split) >= rank:
                high, first = middle, np.maximum(first, split)
            else:
                low, last = middle, np.minimum(last, split)
        return self._listed(first, last, rank - self._pairs_from(last))

    def _pairs_from(self, start: NDArray[np.int64]) -> int:
        """How many pairs have their y at or after `start`, an index for each x."""
        until = np.concatenate([[0], np.cumsum(self.times_y)])
        return int(self.times_x @ (until[-1] - until[start]))

    def _listed(self, first: NDArray[np.int64], last: NDArray[np.int64], rank: int) -> float:
        """Return the `rank`-th smallest difference of each x with its y from first to last."""
        lengths = np.maximum(last - first, 0)
        ends = np.cumsum(lengths)
        of_x = np.repeat(np.arange(len(self.x)), lengths)
        of_y = np.arange(ends[-1]) - (ends - lengths - first)[of_x]
        differences = self.x[of_x] - self.y[of_y]
        order = np.argsort(differences)
        counted = np.cumsum((self.times_x[of_x] * self.times_y[of_y])[order])
        return float(differences[order[np.searchsorted(counted, rank)]])
