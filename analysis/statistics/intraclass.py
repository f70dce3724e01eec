"""How much trials of one participant resemble each other."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .codes import NO_VARIATION, ONE_PARTICIPANT, SINGLE_TRIALS
from .estimates import LEVEL
from .influence import cluster_count, of_mean
from .outcome import Outcome
from .result import TestResult

_ROUNDING = 1e-12
"""Deviations below this share of the largest are zeros that rounding blurred."""


@dataclass(frozen=True, kw_only=True)
class IntraclassCorrelation(TestResult):
    """Correlation of two trials of a participant within an arm; F tests whether it is 0.

    p is two-sided, as the interval is.

    `trials_per_participant` is the number with which the design effect of a difference between
    the arms is 1 + (trials_per_participant - 1) estimate: in an arm of n trials the mean over
    trials (sum m^2 / n for participants of m), averaged over arms with weights 1 / n.
    """

    df: tuple[float, float]
    trials_per_participant: float
    participants: int


def intraclass_correlation(outcome: Outcome) -> IntraclassCorrelation:
    """Estimate from the analysis of variance of participants within arms, with Searle's interval.

    The interval is exact for normal values and equal numbers of trials, else approximate. F is
    not defined, with a warning, if each arm has one participant, each participant one trial, or
    no participant's trials differ (then the correlation is 1, or None if nobody differs either).
    EmptyArmError if an arm has no value. Source: Donner and Klar (2000), Design and Analysis of
    Cluster Randomization Trials; Searle (1971), Linear Models.
    """
    data = outcome.present()
    n, participants = len(data.y), cluster_count(data.participant)
    df = participants - 2, n - participants
    between, within, size = _mean_squares(data, df) if min(df) > 0 else (0.0, 0.0, 1.0)
    estimate = low = high = f = p = None
    if between or within:
        estimate = (between - within) / (between + (size - 1) * within)
    if within:
        f = between / within
        p, low, high = _of_f(f, df, size)
    return IntraclassCorrelation(
        estimate=estimate,
        low=low,
        high=high,
        null=0.0,
        unit="correlation",
        symbol="F",
        statistic=f,
        df=df,
        p=p,
        n=n,
        n_missing=outcome.n_missing,
        method="intraclass correlation of participants within arms, from analysis of variance",
        source="Donner and Klar (2000), Design and Analysis of Cluster Randomization Trials; "
        "interval of Searle (1971), Linear Models",
        warnings=_warnings(df, within),
        trials_per_participant=_trials_per_participant(data),
        participants=participants,
    )


def intraclass_correlation_of_ranks(outcome: Outcome) -> IntraclassCorrelation:
    """Estimate it for the mid-ranks of all trials, whose sum a Mann-Whitney test compares.

    All else is as in `intraclass_correlation`.
    """
    from scipy import stats

    ranks = stats.rankdata(outcome.y, nan_policy="omit")
    found = intraclass_correlation(replace(outcome, y=ranks))
    return replace(found, method=f"{found.method} of mid-ranks")


def _trials_per_participant(data: Outcome) -> float:
    """Return the number of trials as it counts for a difference, exact if all have the same."""
    (n, squares), (others, their_squares) = (
        (int(arm.sum()), int((np.bincount(data.participant[arm]) ** 2).sum()))
        for arm in (data.treated, ~data.treated)
    )
    return (squares * others**2 + their_squares * n**2) / (n * others * (n + others))


def _mean_squares(data: Outcome, df: tuple[int, int]) -> tuple[float, float, float]:
    """Return the mean squares between and within participants, and their size as it counts here."""
    deviations, unequal = np.empty_like(data.y), 0.0
    for arm in (data.treated, ~data.treated):
        deviations[arm] = of_mean(data.y[arm]).h * arm.sum()
        unequal += float((np.bincount(data.participant[arm]) ** 2).sum() / arm.sum())
    sizes = np.bincount(data.participant)
    means = np.bincount(data.participant, deviations) / sizes
    residuals = deviations - means[data.participant]
    residuals[np.abs(residuals) < _ROUNDING * np.abs(deviations).max()] = 0
    between, within = float(sizes @ means**2), float(residuals @ residuals)
    return between / df[0], within / df[1], (len(data.y) - unequal) / df[0]


def _of_f(f: float, df: tuple[int, int], size: float) -> tuple[float, float, float]:
    """Return p, two-sided as the interval is, and Searle's interval."""
    from scipy.special import fdtr, fdtrc, fdtri

    upper, lower = (f / float(fdtri(*df, q)) for q in ((1 - LEVEL) / 2, (1 + LEVEL) / 2))
    low, high = ((ratio - 1) / (ratio + size - 1) for ratio in (lower, upper))
    return 2 * float(min(fdtr(*df, f), fdtrc(*df, f))), low, high


def _warnings(df: tuple[int, int], within: float) -> tuple[str, ...]:
    if df[0] <= 0:
        return (ONE_PARTICIPANT,)
    if df[1] <= 0:
        return (SINGLE_TRIALS,)
    return () if within else (NO_VARIATION,)
