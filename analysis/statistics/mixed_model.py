"""Correct guesses by a logistic mixed model with crossed participants and scenarios.

Own code: of the packages tried, mixedlm agrees with R on the estimates but not on the standard
error (it leaves out that variances are estimated), gpboost on neither to three digits, and
statsmodels' BinomialBayesMixedGLM is a Bayesian approximation to another model.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .crossed_fit import CrossedFit
from .crossed_test import CrossedResult, crossed_test
from .outcome import Outcome

_NODES = 64
"""Of the quadrature: exact to 1e-9 for standard deviations up to 3 on the logit scale."""


@dataclass(frozen=True, kw_only=True)
class CrossedLogistic(CrossedResult):
    """The model's log odds ratio of a correct guess, and what it means for shares.

    `intercept`: log odds in the reference arm, of a participant and scenario with effects 0.
    `risk_difference`, from -1 to 1, with its 95 % interval: of the shares that the model expects in
    the arms over all participants and scenarios.
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
    two-way difference. The interval of the risk difference is by the delta method. What cannot be
    estimated: see crossed_test. Source: Breslow and Clayton (1993), Journal of the American
    Statistical Association 88, 9-25; Baayen, Davidson and Bates (2008), Journal of Memory and
    Language 59, 390-412.
    """
    result, fit = crossed_test(
        outcome,
        interaction=interaction,
        method="Crossed logistic mixed model",
        source="Breslow and Clayton (1993); agrees with R glmmTMB",
    )
    difference = low = high = None
    if fit is not None:
        difference, se = _risk_difference(fit)
        if result.se and result.high is not None:
            half = (result.high - fit.effect) / result.se * se
            low, high = difference - half, difference + half
    return CrossedLogistic(
        **vars(result),
        intercept=None if fit is None else fit.location - fit.effect / 2,
        risk_difference=difference,
        risk_difference_low=low,
        risk_difference_high=high,
    )


def _risk_difference(fit: CrossedFit) -> tuple[float, float]:
    """Return the difference of the arms' expected shares, over random effects, and its error."""
    from scipy.special import expit

    nodes, weights = np.polynomial.hermite_e.hermegauss(_NODES)
    weights = weights / weights.sum()
    sd = math.hypot(*fit.sds)
    shares = expit(fit.location + np.array([[-0.5], [0.5]]) * fit.effect + sd * nodes)
    density = shares * (1 - shares)
    by_location = density @ weights
    by_sd = density @ (weights * nodes)
    gradient = np.concatenate(
        [
            [by_location[1] - by_location[0], by_location.mean()],
            (by_sd[1] - by_sd[0]) * (fit.sds / sd if sd > 0 else fit.sds),
        ]
    )
    reference, treatment = shares @ weights
    return float(treatment - reference), float(gradient @ fit.covariance @ gradient) ** 0.5
