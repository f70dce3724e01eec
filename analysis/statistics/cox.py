"""How much sooner trials of one arm come to a correct stop: Cox regression on the arm.

Own code: statsmodels' PHReg and lifelines' CoxPHFitter estimate the same, but take half a minute
for 100,000 trials; on one binary covariate every sum of the method is a count by arm and time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .codes import FEW_CLUSTERS, NO_VARIATION, ONE_PARTICIPANT, SEPARATION
from .estimates import LEVEL
from .inference import FEW
from .outcome import Numbers
from .result import TestResult
from .survival import CORRECT, Stops

_REACH = 100.0
"""No finite estimate lies outside +-_REACH: log hazard ratios are of the order of log N."""


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


class _Terms(NamedTuple):
    """The partial likelihood: a term for each of E correct stops at U different times.

    Of shape (U,): `times_s`, `events` at each; of shape (E,): `at`, number of the stop's time;
    `gone`, the share of the stops tied with it that Efron counts as over; `treated`, `reference`:
    how many are at risk, less the share that is gone.
    """

    times_s: Numbers
    events: NDArray[np.int64]
    at: NDArray[np.int64]
    gone: Numbers
    treated: Numbers
    reference: Numbers

    def mean(self, estimate: float) -> Numbers:
        """Return the treatment arm's share of the rate of correct stops at each, shape (E,)."""
        return self.treated * math.exp(estimate) / self.rate(estimate)

    def rate(self, estimate: float) -> Numbers:
        """Return the rate of correct stops at each in trials of the reference arm, shape (E,)."""
        return self.reference + self.treated * math.exp(estimate)


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
    from scipy import optimize

    correct = stops.ending == CORRECT
    terms = _terms(stops, correct)
    of_treated = int((correct & stops.treated).sum())
    if of_treated in (int((terms.reference == 0).sum()), int((terms.treated > 0).sum())):
        return _result(stops, warnings=(SEPARATION,))
    estimate = float(optimize.brentq(lambda at: of_treated - terms.mean(at).sum(), -_REACH, _REACH))
    mean = terms.mean(estimate)
    information = float((mean * (1 - mean)).sum())
    naive_se = information**-0.5
    if 1 in stops.participants_per_arm:
        return _result(stops, estimate, naive_se, warnings=(ONE_PARTICIPANT,))
    of_participant = np.bincount(
        stops.participant, _score_residuals(stops, correct, terms, estimate)
    )
    se = float(np.sqrt(of_participant @ of_participant)) / information
    if se < 1e-9 * naive_se:
        return _result(stops, estimate, naive_se, warnings=(NO_VARIATION,))
    few = (FEW_CLUSTERS,) if min(stops.participants_per_arm) < FEW else ()
    return _result(stops, estimate, naive_se, se, warnings=few)


def _terms(stops: Stops, correct: NDArray[np.bool_]) -> _Terms:
    """Count who is at risk at every correct stop."""
    times_s, number, events = np.unique(
        stops.time_s[correct], return_inverse=True, return_counts=True
    )
    at = np.repeat(np.arange(len(times_s)), events)
    gone = (np.arange(len(at)) - (np.cumsum(events) - events)[at]) / events[at]
    at_risk = []
    for arm in (stops.treated, ~stops.treated):
        ends = np.sort(stops.time_s[arm])
        there = len(ends) - np.searchsorted(ends, times_s, side="left")
        here = np.bincount(number[arm[correct]], minlength=len(times_s))
        at_risk.append(there[at] - gone * here[at])
    return _Terms(times_s, events, at, gone, *at_risk)


def _score_residuals(
    stops: Stops, correct: NDArray[np.bool_], terms: _Terms, estimate: float
) -> Numbers:
    """Return each trial's share in the score, shape (N,); they sum to 0 at the estimate."""
    n_times = len(terms.times_s)
    mean, rate = terms.mean(estimate), terms.rate(estimate)
    passed = np.searchsorted(terms.times_s, stops.time_s, side="right")
    residuals = np.empty(len(stops.time_s))
    for arm, of_arm in ((1.0, stops.treated), (0.0, ~stops.treated)):
        pull = math.exp(estimate * arm) * (arm - mean) / rate
        own = (arm - mean) / terms.events[terms.at] + terms.gone * pull
        at_risk = np.append(0.0, np.cumsum(np.bincount(terms.at, pull, n_times)))
        at_stop = np.bincount(terms.at, own, n_times)
        residuals[of_arm] = -at_risk[passed[of_arm]]
        stopped = of_arm & correct
        residuals[stopped] += at_stop[passed[stopped] - 1]
    return residuals


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
    ratio, ratio_low, ratio_high = (
        None if log is None else math.exp(log) for log in (estimate, low, high)
    )
    return CoxResult(
        estimate=estimate,
        low=low,
        high=high,
        null=0.0,
        unit="log hazard ratio",
        symbol="z",
        statistic=z,
        p=p,
        n=len(stops.time_s),
        n_missing=stops.n_missing,
        method="Cox regression of the time to a correct stop, wrong stops censored, Efron ties, "
        "standard error clustered by participant",
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
