"""Correct guesses by a logistic mixed model with crossed participants and scenarios.

Own code: of the packages tried, mixedlm agrees with R on the estimates but not on the standard
error (it leaves out that variances are estimated), gpboost on neither to three digits, and
statsmodels' BinomialBayesMixedGLM is a Bayesian approximation to another model.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from .crossed_fit import CrossedFit
from .crossed_test import CrossedResult, crossed_test
from .outcome import UNKNOWN, Outcome

_NODES = 64
"""Of the quadrature: exact to 1e-9 for standard deviations up to 3 on the logit scale."""


@dataclass(frozen=True, kw_only=True)
class CrossedLogistic(CrossedResult):
    """The model's log odds ratio of a correct guess, and what it means for shares.

    `intercept`: log odds in the reference arm, of a participant and scenario with effects 0.
    `risk_difference`, from -1 to 1, with its 95 % interval: of the shares that the model expects in
    the arms over all participants and scenarios. It excludes 0 if and only if the estimate's does.
    """

    intercept: float | None
    risk_difference: float | None
    risk_difference_low: float | None
    risk_difference_high: float | None


def crossed_logistic(outcome: Outcome, interaction: bool = True) -> CrossedLogistic:
    """Test the arm in correct ~ arm + (1 | participant) + (1 | scenario) + (1 | scenario in arm).

    `outcome.y` is 1 where correct, else 0; without `interaction` the last term is left out. Maximum
    likelihood by Laplace's approximation, as R's glmmTMB and lme4 (nAGQ = 1); standard error from
    the observed information of all parameters, as glmmTMB; t on the degrees of freedom of the
    two-way difference. The interval of the risk difference is that of the log odds ratio, carried
    through the model: one by the delta method could exclude 0 where the test does not. What cannot
    be estimated: see crossed_test. Source: Breslow and Clayton (1993), Journal of the American
    Statistical Association 88, 9-25; Baayen, Davidson and Bates (2008), Journal of Memory and
    Language 59, 390-412.
    """
    return _logistic(outcome, interaction, "Crossed logistic mixed model")


def participant_logistic(outcome: Outcome) -> CrossedLogistic:
    """Test the arm in correct ~ arm + (1 | participant): scenarios are left out of account.

    It rejects too often where scenarios differ between the arms. `outcome.y` is 1 where correct,
    else 0; all else is as in `crossed_logistic`, t on the participants' degrees of freedom.
    """
    without = replace(outcome, scenario=np.full_like(outcome.scenario, UNKNOWN))
    return _logistic(without, False, "Logistic mixed model of participants only")


def _logistic(outcome: Outcome, interaction: bool, method: str) -> CrossedLogistic:
    result, fit = crossed_test(
        outcome,
        interaction=interaction,
        method=method,
        source="Breslow and Clayton (1993); agrees with R glmmTMB",
    )
    difference = low = high = None
    if fit is not None:
        difference = _risk_difference(fit, fit.effect)
        if result.low is not None and result.high is not None:
            reached = [difference, *(_risk_difference(fit, at) for at in (result.low, result.high))]
            low, high = min(reached), max(reached)
    return CrossedLogistic(
        **vars(result),
        intercept=None if fit is None else fit.location - fit.effect / 2,
        risk_difference=difference,
        risk_difference_low=low,
        risk_difference_high=high,
    )


def _risk_difference(fit: CrossedFit, effect: float) -> float:
    """Return the difference of the arms' expected shares, over random effects, at an effect.

    Location and standard deviations are the most probable ones with it, by the curvature at the
    maximum. Both arms share them, so the difference has the sign of the effect.
    """
    from scipy.special import expit

    nodes, weights = np.polynomial.hermite_e.hermegauss(_NODES)
    moved = (effect - fit.effect) * fit.covariance[1] / fit.covariance[1, 1]
    location, sd = fit.location + moved[0], math.hypot(*(fit.sds + moved[2:]))
    shares = expit(location + np.array([[-0.5], [0.5]]) * effect + sd * nodes)
    reference, treatment = shares @ (weights / weights.sum())
    return float(treatment - reference)
