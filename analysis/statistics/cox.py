"""How much sooner trials of one arm come to a correct stop: Cox regression on the arm.

The estimate is one, its uncertainty is told twice: with participants as the clusters, and with
participants and scenarios. It is the ratio over all scenarios together. Strata by scenario would
ask for the ratio within each; under no difference both are 1 where scenarios differ in their
rates, or differ between the arms by chance, and both hold their level with the two-way variance.
Without strata both tests are of one ratio, and no scenario seen in one arm only is lost.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .codes import FEW_CLUSTERS, NO_VARIATION, NOT_CONVERGED, ONE_PARTICIPANT, SEPARATION
from .cox_fit import CoxFit, CoxLikelihood
from .estimates import LEVEL
from .inference import FEW, undefined
from .influence import Influence, cluster_count
from .outcome import Numbers, Outcome
from .result import TestResult
from .survival import CORRECT, Stops
from .two_way import SOURCE, TwoWay, TwoWayInference, two_way

UNIT = "log hazard ratio"
METHOD = "Cox regression of the time to a correct stop, wrong stops censored, Efron ties"


@dataclass(frozen=True, kw_only=True)
class CoxResult(TestResult):
    """Log hazard ratio of a correct stop, treatment against reference, and its test.

    `hazard_ratio` with its 95 % interval is the exponential; `naive_se` treats trials as
    independent; `n_events` counts correct stops.
    """

    hazard_ratio: float | None
    hazard_ratio_low: float | None
    hazard_ratio_high: float | None
    naive_se: float | None
    n_events: int
    n_participants: int


@dataclass(frozen=True, kw_only=True)
class TwoWayCox(TwoWay):
    """The same log hazard ratio with the variance by participants and scenarios."""

    hazard_ratio: float | None
    hazard_ratio_low: float | None
    hazard_ratio_high: float | None
    n_events: int


def clustered_cox(stops: Stops) -> CoxResult:
    """Test whether correct stops come at the same rate in both arms, whatever wrong stops do.

    The cause-specific hazard: wrong stops and ends of the animation are censored where they are.
    Positive: correct stops come sooner in the treatment arm. Ties by Efron; standard error from
    score residuals summed over participants; z test. Where an arm has no correct stop while the
    other is at risk, the ratio is 0 or infinite: no estimate, and the warning `separation`. With
    one participant in an arm, or if participants do not differ, there is no standard error.
    O(N log N). Source: Cox (1972), Efron (1977), Lin and Wei (1989), as R's survival::coxph with
    `cluster`.
    """
    fit, reason = fitted(stops)
    if fit is None:
        return _result(stops, warnings=(reason,))
    estimate, naive_se = float(fit.coefficients[0]), float(fit.naive[0, 0]) ** 0.5
    if 1 in stops.participants_per_arm:
        return _result(stops, estimate, naive_se, warnings=(ONE_PARTICIPANT,))
    of_participant = np.bincount(stops.participant, fit.influence[:, 0])
    se = float(np.sqrt(of_participant @ of_participant))
    if se < 1e-9 * naive_se:
        return _result(stops, estimate, naive_se, warnings=(NO_VARIATION,))
    few = (FEW_CLUSTERS,) if min(stops.participants_per_arm) < FEW else ()
    return _result(stops, estimate, naive_se, se, warnings=few)


def two_way_cox(stops: Stops) -> TwoWayCox:
    """Test the same for other participants and other scenarios alike.

    Influence values are score residuals times the naive variance; their sums over participants,
    scenarios and trials make the variance, and t is tested, as in every two-way test (see
    two_way). The ratio is marginal: of all trials, whatever their scenario. Each arm has much the
    same scenarios, so what scenarios have in common between the arms cancels, and what they do not
    is in the variance by scenario. `separation` as in clustered_cox. Source: Lin and Wei (1989),
    Journal of the American Statistical Association 84, 1074-1078; Cameron, Gelbach and Miller
    (2011).
    """
    return result_of(stops, *fitted(stops))


def result_of(stops: Stops, fit: CoxFit | None, reason: str, adjusted: str = "") -> TwoWayCox:
    """Return the two-way test of the arm in a fit, or that there is none; as `fitted` tells."""
    inference = (
        _undefined_two_way(stops, reason) if fit is None else coefficient_test(stops, fit, 0)
    )
    ratio, low, high = _ratios(inference["estimate"], inference["low"], inference["high"])
    return TwoWayCox(
        **inference,
        unit=UNIT,
        n=len(stops.time_s),
        n_missing=stops.n_missing,
        method=f"{METHOD}{adjusted}, variance two-way clustered by participant and scenario",
        source=f"Cox (1972), Lin and Wei (1989); {SOURCE}",
        hazard_ratio=ratio,
        hazard_ratio_low=low,
        hazard_ratio_high=high,
        n_events=int((stops.ending == CORRECT).sum()),
    )


def fitted(stops: Stops, covariates: Numbers | None = None) -> tuple[CoxFit | None, str]:
    """Fit the arm, and covariates, shape (N, K), beside it; if there is no fit, why not."""
    columns = [stops.treated[:, None].astype(np.float64)]
    if covariates is not None:
        columns.append(covariates)
    likelihood = CoxLikelihood(stops.time_s, stops.ending == CORRECT, np.hstack(columns))
    if likelihood.is_separated(stops.treated):
        return None, SEPARATION
    return likelihood.fit(), NOT_CONVERGED


def coefficient_test(stops: Stops, fit: CoxFit, column: int) -> TwoWayInference:
    """Test one coefficient of a fit against 0, clustered by participant and scenario."""
    influence = Influence(float(fit.coefficients[column]), fit.influence[:, column])
    return two_way(_trials(stops), influence, 0.0)


def _undefined_two_way(stops: Stops, reason: str) -> TwoWayInference:
    """Return that nothing is known, and why."""
    data = _trials(stops)
    return TwoWayInference(
        **undefined(None, 0.0, reason),
        v_participant=None,
        v_scenario=None,
        v_trial=None,
        participants=cluster_count(data.participant),
        scenarios=cluster_count(data.scenario[data.scenario >= 0]),
    )


def _trials(stops: Stops) -> Outcome:
    """The trials as the two-way variance takes them."""
    return Outcome(
        "time to a correct stop",
        UNIT,
        stops.time_s,
        stops.treated,
        stops.participant,
        stops.scenario,
    )


def _ratios(*logs: float | None) -> tuple[float | None, ...]:
    return tuple(None if log is None else math.exp(log) for log in logs)


def _result(
    stops: Stops,
    estimate: float | None = None,
    naive_se: float | None = None,
    se: float | None = None,
    *,
    warnings: tuple[str, ...] = (),
) -> CoxResult:
    """Return what is known of the log hazard ratio."""
    from scipy import stats

    low = high = z = p = None
    if estimate is not None and se is not None:
        half = float(stats.norm.ppf((1 + LEVEL) / 2)) * se
        low, high, z = estimate - half, estimate + half, estimate / se
        p = float(2 * stats.norm.sf(abs(z)))
    ratio, ratio_low, ratio_high = _ratios(estimate, low, high)
    return CoxResult(
        estimate=estimate,
        low=low,
        high=high,
        null=0.0,
        unit=UNIT,
        symbol="z",
        statistic=z,
        p=p,
        n=len(stops.time_s),
        n_missing=stops.n_missing,
        method=f"{METHOD}, standard error clustered by participant",
        source="as R survival::coxph(cluster = participant); Cox (1972), Lin and Wei (1989)",
        se=se,
        warnings=warnings,
        hazard_ratio=ratio,
        hazard_ratio_low=ratio_low,
        hazard_ratio_high=ratio_high,
        naive_se=naive_se,
        n_events=int((stops.ending == CORRECT).sum()),
        n_participants=sum(stops.participants_per_arm),
    )
