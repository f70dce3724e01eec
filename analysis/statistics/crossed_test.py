"""The test of the arm in a mixed model with crossed participants and scenarios."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .codes import (
    CONSTANT_OUTCOME,
    FEW_CLUSTERS,
    NO_SCENARIO_SHARED,
    NOT_CONVERGED,
    ONE_PARTICIPANT,
    ONE_SCENARIO,
    SEPARATION,
    SINGLE_TRIALS,
    TOO_MANY_CLUSTERS,
    ZERO_VARIANCE,
)
from .crossed_fit import CrossedFit, CrossedModel
from .degrees_of_freedom import (
    by_participant_and_scenario,
    known_scenarios,
    participants_of_arms,
)
from .inference import FEW, Inference, student, undefined
from .influence import cluster_count, of_auc
from .outcome import Clusters, Numbers, Outcome
from .result import TestResult

_NO_SD = 1e-3
"""A standard deviation below this, on the logit scale, is estimated as 0."""

_MOST_SCENARIOS = 500
"""Beyond, the dense block of scenarios and scenarios within arm takes minutes."""

Factors = tuple[Clusters | None, Clusters | None, Clusters | None]


@dataclass(frozen=True, kw_only=True)
class CrossedResult(TestResult):
    """Log odds ratio of higher values, treatment against reference, and its t test.

    It compares the same participant and scenario; `odds_ratio` with its 95 % interval is the
    exponential. `sd_...`: standard deviations of the random effects on the logit scale, None for
    one left out. `likelihood_ratio` tests the same by chi2 on 1 degree of freedom.
    """

    odds_ratio: float | None
    odds_ratio_low: float | None
    odds_ratio_high: float | None
    sd_participant: float | None
    sd_scenario: float | None
    sd_scenario_in_arm: float | None
    log_likelihood: float | None
    likelihood_ratio: float | None
    likelihood_ratio_p: float | None


def crossed_test(
    outcome: Outcome,
    *,
    interaction: bool,
    method: str,
    source: str,
    covariates: Numbers | None = None,
) -> tuple[CrossedResult, CrossedFit | None]:
    """Fit values ~ arm + (1 | participant) + (1 | scenario) [+ (1 | scenario in arm)], and test.

    `covariates`, shape (N, K), are further fixed effects of the N trials that have a value.

    By t on the degrees of freedom of the two-way AUC, which for values 0 and 1 are those of the
    two-way difference; the standard error counts in that variances are estimated. No estimate, and
    no fit, if all values are equal, if every value of one arm is at least every value of the other
    (`separation`), if there are more than 500 scenarios or if no maximum is found; no test with one
    scenario or one participant in an arm. A factor that trials cannot tell from others is left out.
    Each of these adds a warning. Where no scenario is known, participants alone are random.
    EmptyArmError if an arm has no value.
    """
    from scipy.special import chdtrc
    from threadpoolctl import threadpool_limits

    data = outcome.present()
    factors, warnings = _factors(data, interaction)
    reason = _obstacle(data)
    fit = ratio = None
    if reason is None:
        category: NDArray[np.int64] = np.unique(data.y, return_inverse=True)[1]
        model = CrossedModel(category, data.treated, factors, covariates)
        with threadpool_limits(1, user_api="blas"):
            fit = model.fit()
            if fit is not None:
                without = model.log_likelihood_without_effect(fit)
                ratio = max(0.0, 2 * (fit.log_likelihood - without))
    sds: list[float | None] = [None] * 3
    if fit is None:
        inference = undefined(None, 0.0, *warnings, reason or NOT_CONVERGED)
    else:
        for i, factor in enumerate(factors):
            if factor is not None:
                sds[i] = 0.0 if fit.sds[i] < _NO_SD else float(fit.sds[i])
        inference = _inference(data, fit, warnings + (ZERO_VARIANCE,) * (0.0 in sds))
    within = "" if factors[2] is None else " with scenarios within arms"
    result = CrossedResult(
        **inference,
        unit="log odds",
        n=len(data.y),
        n_missing=outcome.n_missing,
        method=f"{method}{within}, maximum likelihood by Laplace's approximation",
        source=source,
        odds_ratio=_exp(inference["estimate"]),
        odds_ratio_low=_exp(inference["low"]),
        odds_ratio_high=_exp(inference["high"]),
        sd_participant=sds[0],
        sd_scenario=sds[1],
        sd_scenario_in_arm=sds[2],
        log_likelihood=None if fit is None else fit.log_likelihood,
        likelihood_ratio=ratio,
        likelihood_ratio_p=None if ratio is None else float(chdtrc(1, ratio)),
    )
    return result, fit


def _factors(data: Outcome, interaction: bool) -> tuple[Factors, tuple[str, ...]]:
    """Return participants, scenarios and scenarios in arms, None for what cannot be estimated."""
    n, scenarios = len(data.y), known_scenarios(data)
    people = data.participant if cluster_count(data.participant) < n else None
    warnings = [] if people is not None else [SINGLE_TRIALS]
    if not scenarios:
        return (people, None, None), tuple(warnings)
    cells = np.unique(2 * data.scenario + data.treated, return_inverse=True)[1]
    shared = cluster_count(cells) > scenarios
    if not shared:
        warnings.append(NO_SCENARIO_SHARED)
    in_arms = interaction and shared and scenarios > 1 and cluster_count(cells) < n
    factors = (
        people,
        data.scenario if 1 < scenarios < n else None,
        cells if in_arms else None,
    )
    return factors, tuple(warnings)


def _obstacle(data: Outcome) -> str | None:
    """Return why there is no estimate to look for, None if there may be one."""
    treatment, reference = data.y[data.treated], data.y[~data.treated]
    if data.y.min() == data.y.max():
        return CONSTANT_OUTCOME
    if treatment.min() >= reference.max() or reference.min() >= treatment.max():
        return SEPARATION
    if known_scenarios(data) > _MOST_SCENARIOS:
        return TOO_MANY_CLUSTERS
    return None


def _inference(data: Outcome, fit: CrossedFit, warnings: tuple[str, ...]) -> Inference:
    scenarios = known_scenarios(data)
    fewest = min(participants_of_arms(data))
    if fewest == 1:
        return undefined(fit.effect, 0.0, *warnings, ONE_PARTICIPANT)
    if scenarios == 1:
        return undefined(fit.effect, 0.0, *warnings, ONE_SCENARIO)
    if min(fewest, scenarios or fewest) < FEW:
        warnings = (*warnings, FEW_CLUSTERS)
    df = by_participant_and_scenario(data, of_auc(data).h)
    return student(fit.effect, 0.0, float(fit.covariance[1, 1]), df, *warnings)


def _exp(value: float | None) -> float | None:
    return None if value is None else math.exp(value)
