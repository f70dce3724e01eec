"""Shares and means with their 95 % intervals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

LEVEL = 0.95
"""Confidence level of every interval."""

Values = Sequence[float] | NDArray[np.float64]
"""Numbers of one arm; NaN stands for a missing one."""


@dataclass(frozen=True)
class Share:
    """How many of n were so, with Wilson's interval; `share`, `low` and `high` are 0 to 1."""

    n: int
    n_missing: int
    count: int
    share: float
    low: float
    high: float
    method: str = "Wilson score interval, 95 %"


@dataclass(frozen=True)
class Mean:
    """Location and spread of n values in `unit`, with Student's t interval of the mean.

    `sd`, `low` and `high` are None for a single value.
    """

    unit: str
    n: int
    n_missing: int
    mean: float
    sd: float | None
    low: float | None
    high: float | None
    median: float
    minimum: float
    maximum: float
    method: str = "Student's t interval of the mean, 95 %, n - 1 degrees of freedom"


def share(count: int, n: int, n_missing: int = 0) -> Share:
    """Return `count` of `n` > 0 as a share with Wilson's 95 % interval.

    Source: Wilson (1927), by scipy.stats.binomtest; equals R's prop.test without continuity
    correction.
    """
    from scipy import stats

    interval = stats.binomtest(count, n).proportion_ci(LEVEL, method="wilson")
    return Share(n, n_missing, count, count / n, float(interval.low), float(interval.high))


def mean(values: Values, unit: str) -> Mean:
    """Return the mean of at least one present value with its 95 % t interval."""
    from scipy import stats

    present, n_missing = without_missing(values)
    n = len(present)
    average = float(present.mean())
    sd = low = high = None
    if n > 1:
        sd = float(present.std(ddof=1))
        half = float(stats.t.ppf((1 + LEVEL) / 2, n - 1)) * sd / n**0.5
        low, high = average - half, average + half
    return Mean(
        unit=unit,
        n=n,
        n_missing=n_missing,
        mean=average,
        sd=sd,
        low=low,
        high=high,
        median=float(np.median(present)),
        minimum=float(present.min()),
        maximum=float(present.max()),
    )


def without_missing(values: Values) -> tuple[NDArray[np.float64], int]:
    """Return the values that are no NaN, and how many were."""
    array = np.asarray(values, dtype=np.float64)
    present = array[~np.isnan(array)]
    return present, len(array) - len(present)
