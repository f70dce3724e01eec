"""Means with intervals, and paired tests with effect sizes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats

from policies.mdp import Array

LEVEL = 0.95


@dataclass(frozen=True)
class Interval:
    """A mean of `n` values with Student's t interval at 95 %; nan where it takes more values."""

    n: int
    mean: float
    low: float
    high: float


@dataclass(frozen=True)
class PairedTest:
    """Difference a - b of pairs, tested by means (t) and by signed ranks (Wilcoxon).

    `d_z`: mean difference over its standard deviation; `rank_biserial`: the sum of ranks of
    positive differences minus that of negative ones, over both (Kerby, 2014). Pairs without a
    difference have no rank.
    """

    difference: Interval
    t: float
    p_t: float
    d_z: float
    p_wilcoxon: float
    rank_biserial: float


def mean_interval(values: Array) -> Interval:
    """Mean of independent values, shape (n,)."""
    n = len(values)
    if n == 0:
        return Interval(0, np.nan, np.nan, np.nan)
    mean = float(values.mean())
    if n == 1:
        return Interval(1, mean, np.nan, np.nan)
    half = float(stats.t.ppf((1 + LEVEL) / 2, n - 1) * values.std(ddof=1) / np.sqrt(n))
    return Interval(n, mean, mean - half, mean + half)


def paired_test(a: Array, b: Array) -> PairedTest:
    """Test pairs, shapes (n,); with less than two, or none that differs, p = 1, effects nan."""
    d = a - b
    difference = mean_interval(d)
    differing = d[d != 0]
    if len(d) < 2 or not len(differing):
        return PairedTest(difference, np.nan, 1.0, np.nan, 1.0, np.nan)
    sd = float(d.std(ddof=1))
    d_z = difference.mean / sd if sd else float(np.copysign(np.inf, difference.mean))
    t = d_z * float(np.sqrt(len(d)))
    ranks = stats.rankdata(np.abs(differing))
    return PairedTest(
        difference,
        t=t,
        p_t=float(2 * stats.t.sf(abs(t), len(d) - 1)),
        d_z=d_z,
        p_wilcoxon=float(stats.wilcoxon(d, method="approx").pvalue),
        rank_biserial=float(ranks @ np.sign(differing) / ranks.sum()),
    )


def holm(p: Sequence[float]) -> list[float]:
    """Holm's (1979) adjusted p values of a family of tests, in the order given."""
    adjusted = [0.0] * len(p)
    largest = 0.0
    for rank, i in enumerate(np.argsort(p, kind="stable")):
        largest = max(largest, min(1.0, (len(p) - rank) * p[i]))
        adjusted[i] = largest
    return adjusted
