"""Logistic regression of correct guesses by generalized estimating equations."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np

from .codes import NO_VARIATION, NOT_CONVERGED, ONE_PARTICIPANT, SEPARATION, SINGLE_TRIALS
from .estimates import LEVEL
from .influence import cluster_count, cluster_variance, of_difference
from .outcome import Outcome
from .result import TestResult

LARGEST = 20_000
"""Participants above which a report does without: statsmodels goes through them one by one."""


@dataclass(frozen=True, kw_only=True)
class Gee(TestResult):
    """Log odds ratio and odds ratio; `working_correlation` of two trials of a participant."""

    odds_ratio: float | None
    odds_ratio_low: float | None
    odds_ratio_high: float | None
    intercept: float | None
    working_correlation: float | None
    participants: int


@dataclass(frozen=True)
class _Fit:
    """Coefficients on the logit scale; the standard error is of the arm's."""

    intercept: float
    arm: float
    se: float
    correlation: float


def gee_logistic(outcome: Outcome) -> Gee:
    """Estimate the arms' log odds ratio, trials of a participant being exchangeable.

    Sandwich standard error without small-sample correction, z. `y` is 0 or 1. Undefined, with a
    warning, if the guesses of an arm are all correct or all wrong, an arm has one participant,
    participants have one trial each or do not differ. EmptyArmError if an arm has no value.
    Source: Liang and Zeger (1986), Biometrika 73, 13-22; as R's geepack::geeglm.
    """
    from scipy.special import ndtr, ndtri

    data = outcome.present()
    obstacle = _obstacle(data)
    fit = None if obstacle else _fit(data)
    z = fit.arm / fit.se if fit else None
    half = float(ndtri((1 + LEVEL) / 2))
    low, high = (fit.arm - half * fit.se, fit.arm + half * fit.se) if fit else (None, None)
    return Gee(
        estimate=fit.arm if fit else None,
        low=low,
        high=high,
        null=0.0,
        unit="log odds ratio",
        symbol="z",
        statistic=z,
        p=None if z is None else 2 * float(ndtr(-abs(z))),
        n=len(data.y),
        n_missing=outcome.n_missing,
        method="logistic regression by generalized estimating equations, exchangeable trials of a "
        "participant, sandwich standard error",
        source="Liang and Zeger (1986), Biometrika 73, 13-22; statsmodels GEE",
        se=fit.se if fit else None,
        warnings=() if fit else (obstacle or NOT_CONVERGED,),
        odds_ratio=math.exp(fit.arm) if fit else None,
        odds_ratio_low=None if low is None else math.exp(low),
        odds_ratio_high=None if high is None else math.exp(high),
        intercept=fit.intercept if fit else None,
        working_correlation=fit.correlation if fit else None,
        participants=cluster_count(data.participant),
    )


def _obstacle(data: Outcome) -> str | None:
    """Return why there is nothing to be fitted, if so."""
    arms = (data.treated, ~data.treated)
    if any(data.y[arm].min() == data.y[arm].max() for arm in arms):
        return SEPARATION
    if any(cluster_count(data.participant[arm]) == 1 for arm in arms):
        return ONE_PARTICIPANT
    if cluster_variance(of_difference(data).h, data.participant) == 0:
        return NO_VARIATION
    return SINGLE_TRIALS if np.bincount(data.participant).max() == 1 else None


def _fit(data: Outcome) -> _Fit | None:
    """Fit with the moments of R's geepack (no degrees of freedom taken off); None if it fails."""
    from statsmodels.genmod.cov_struct import Exchangeable
    from statsmodels.genmod.families import Binomial
    from statsmodels.genmod.generalized_estimating_equations import GEE

    model = GEE(
        data.y,
        np.column_stack([np.ones(len(data.y)), data.treated]),
        groups=data.participant,
        family=Binomial(),
        cov_struct=Exchangeable(),
    )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            result = model.fit(ddof_scale=0)
            variance = float(result.cov_robust[1, 1])
    except (ArithmeticError, np.linalg.LinAlgError, Warning):
        return None
    intercept, arm = map(float, result.params)
    correlation = float(result.cov_struct.dep_params)
    if variance <= 0 or not np.isfinite([intercept, arm, variance, correlation]).all():
        return None
    return _Fit(intercept, arm, math.sqrt(variance), correlation)
