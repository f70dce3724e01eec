"""When trials end, and how: the cumulative incidence of correct and of wrong stops.

A correct stop is the event, a wrong stop competes with it (after it no correct stop can follow),
and a trial watched to the end is censored there, whatever was guessed afterwards.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import EmptyArmError
from .codes import ONE_PARTICIPANT
from .estimates import LEVEL
from .outcome import Clusters, Numbers, renumbered

CENSORED, CORRECT, WRONG = 0, 1, 2
"""How a trial ended: watched to the end, stopped and guessed right, stopped and guessed wrong."""

GRID = 100
"""Above this number of different times, curves are given at quantiles, at most so many."""


@dataclass(frozen=True, eq=False)
class Stops:
    """How N trials ended, all arrays of shape (N,); `n_missing` more could not be used.

    `time_s` is the motion seen, in s, until the trial ended; `ending[i]` is CENSORED, CORRECT or
    WRONG; `treated[i]`: whether trial i is of the treatment arm; `participant[i]`, `scenario[i]`:
    numbers from 0, `UNKNOWN` where a scenario is not known.
    """

    time_s: Numbers
    ending: NDArray[np.int8]
    treated: NDArray[np.bool_]
    participant: Clusters
    scenario: Clusters
    n_missing: int

    @property
    def participants_per_arm(self) -> tuple[int, int]:
        """How many participants the treatment and the reference arm have."""
        treatment, reference = (
            len(np.unique(self.participant[arm])) for arm in (self.treated, ~self.treated)
        )
        return treatment, reference


@dataclass(frozen=True, eq=False)
class Curve:
    """Share of trials that have ended in one way by each of T times, all arrays of shape (T,).

    `low` to `high` is the 95 % interval at each time by itself; it and `se` are None where the
    arm has one participant only.
    """

    share: Numbers
    se: Numbers | None
    low: Numbers | None
    high: Numbers | None


@dataclass(frozen=True, eq=False)
class ArmIncidence:
    """Both ways to stop in one arm; `at_risk`, shape (T,), counts trials not ended before."""

    correct: Curve
    wrong: Curve
    at_risk: NDArray[np.int64]
    n: int
    n_participants: int
    n_correct: int
    n_wrong: int
    n_censored: int


@dataclass(frozen=True, eq=False)
class Incidence:
    """Cumulative incidence in both arms at the same times `time_s`, shape (T,), s, from 0 on."""

    time_s: Numbers
    treatment: ArmIncidence
    reference: ArmIncidence
    n: int
    n_missing: int
    warnings: tuple[str, ...]
    method: str = (
        "Aalen-Johansen cumulative incidence; 95 % pointwise intervals on the log(-log) scale "
        "from the infinitesimal jackknife, clustered by participant"
    )
    source: str = "Aalen and Johansen (1978); Lin and Wei (1989)"


def stops(
    stop_time_s: Numbers,
    length_s: Numbers,
    correct: Numbers,
    treated: NDArray[np.bool_],
    participant: Clusters,
    scenario: Clusters,
) -> Stops:
    """Tell how each trial ended; all arrays of shape (N,), NaN where missing.

    `correct` is 1 or 0; a stop at `length_s` is no stop. A trial that lacks one of the three is
    left out; EmptyArmError if an arm has none left.
    """
    known = ending_known(stop_time_s, length_s, correct)
    for arm, of_arm in (("treatment", treated), ("reference", ~treated)):
        if not (known & of_arm).any():
            raise EmptyArmError(arm, "stop time")
    ending = np.where(correct == 1, CORRECT, WRONG)
    ending[stop_time_s >= length_s] = CENSORED
    return Stops(
        time_s=stop_time_s[known],
        ending=ending[known].astype(np.int8),
        treated=treated[known],
        participant=renumbered(participant[known]),
        scenario=renumbered(scenario[known]),
        n_missing=int((~known).sum()),
    )


def ending_known(stop_time_s: Numbers, length_s: Numbers, correct: Numbers) -> NDArray[np.bool_]:
    """Tell of which trials it is known how they ended; all arrays of shape (N,)."""
    return ~(np.isnan(stop_time_s) | np.isnan(length_s) | np.isnan(correct))


def cumulative_incidence(stops: Stops) -> Incidence:
    """Estimate how many trials of each arm have ended in each way by each time.

    The curves are steps, exact at `time_s`: 0 and every time a trial ended, or at most
    `GRID` quantiles of these if there are more. Beyond the last trial of an arm its curves stay
    as they are. O(N log N). Source: Aalen and Johansen (1978); the variance sums influence values
    over participants (Lin and Wei 1989, as R's survival::survfit with `cluster`) times P / (P - 1).
    """
    ends = np.unique(stops.time_s)
    if len(ends) > GRID:
        ends = np.quantile(stops.time_s, np.linspace(0, 1, GRID), method="inverted_cdf")
    time_s = np.unique(np.append(ends, 0.0))
    treatment, reference = (
        _arm(stops.time_s[arm], stops.ending[arm], stops.participant[arm], time_s)
        for arm in (stops.treated, ~stops.treated)
    )
    return Incidence(
        time_s=time_s,
        treatment=treatment,
        reference=reference,
        n=len(stops.time_s),
        n_missing=stops.n_missing,
        warnings=(ONE_PARTICIPANT,) if 1 in stops.participants_per_arm else (),
    )


class _Trials(NamedTuple):
    """One arm's trials in order of time, and at each of its U different times who was at risk.

    Of shape (N,): `at`, number of the trial's time, `ending`, `participant`; of shape (U,): `end`,
    how many trials end up to it, `at_risk`, `left` who stay beyond it, `survival` just before it.
    """

    at: NDArray[np.int64]
    ending: NDArray[np.int8]
    participant: Clusters
    end: NDArray[np.int64]
    at_risk: NDArray[np.int64]
    left: Numbers
    survival: Numbers


def _arm(
    time_s: Numbers, ending: NDArray[np.int8], participant: Clusters, grid_s: Numbers
) -> ArmIncidence:
    """Return the curves of one arm at the times `grid_s`."""
    order = np.argsort(time_s, kind="stable")
    times, at, here = np.unique(time_s[order], return_inverse=True, return_counts=True)
    ending, end = ending[order], np.cumsum(here)
    at_risk = len(order) - end + here
    left = at_risk - np.bincount(at[ending != CENSORED], minlength=len(times))
    survival = np.cumprod(np.append(1.0, left / at_risk))[:-1]
    members, participant = np.unique(participant[order], return_inverse=True)
    trials = _Trials(at, ending, participant, end, at_risk, left.astype(np.float64), survival)
    last = np.searchsorted(times, grid_s, side="right") - 1
    return ArmIncidence(
        correct=_curve(trials, CORRECT, last),
        wrong=_curve(trials, WRONG, last),
        at_risk=len(order) - np.searchsorted(time_s[order], grid_s, side="left"),
        n=len(order),
        n_participants=len(members),
        n_correct=int((ending == CORRECT).sum()),
        n_wrong=int((ending == WRONG).sum()),
        n_censored=int((ending == CENSORED).sum()),
    )


def _curve(trials: _Trials, cause: int, last: NDArray[np.int64]) -> Curve:
    """Return one cause's curve where time number `last` (-1: none yet) is the latest past."""
    hazard = np.bincount(trials.at[trials.ending == cause], minlength=len(trials.end))
    rise = trials.survival * hazard / trials.at_risk
    incidence = np.append(0.0, np.minimum(np.cumsum(rise), 1.0))
    share = incidence[last + 1]
    if trials.participant.max() == 0:
        return Curve(share, None, None, None)
    se = _clustered_se(trials, cause, rise, incidence, last)
    low, high = _log_log_interval(share, se)
    return Curve(share, se, low, high)


def _clustered_se(
    trials: _Trials, cause: int, rise: Numbers, incidence: Numbers, last: NDArray[np.int64]
) -> Numbers:
    """Return the standard error at each time of the grid, clustered by participant.

    The influence of a trial ended at u on the incidence F(t), u <= t, is a line in F(t), of which
    `fixed` and `slope` are summed; trials still at risk after t all have the same, `pending`.
    """
    at = trials.at
    # where nobody is left the curve ends, and what would be divided by 0 counts for nothing
    per_left = np.divide(1.0, trials.left, out=np.zeros_like(trials.left), where=trials.left > 0)
    spread = (1 - trials.left / trials.at_risk) * per_left
    a, b, c = (
        np.append(0.0, np.cumsum(terms))
        for terms in (rise / trials.at_risk, spread, spread * incidence[1:])
    )
    own = np.where(trials.ending == cause, (trials.survival / trials.at_risk)[at], 0.0)
    gone = np.where(trials.ending != CENSORED, per_left[at], 0.0)
    fixed = own - (a + c)[at + 1] + gone * incidence[at + 1]
    slope = b[at + 1] - gone

    pending_count = np.bincount(trials.participant).astype(np.float64)
    fixed_sum, slope_sum = np.zeros_like(pending_count), np.zeros_like(pending_count)
    variance = np.empty(len(last))
    start = 0
    for point, now in enumerate(last + 1):
        stop = trials.end[now - 1] if now else 0
        who = trials.participant[start:stop]
        np.add.at(fixed_sum, who, fixed[start:stop])
        np.add.at(slope_sum, who, slope[start:stop])
        np.subtract.at(pending_count, who, 1.0)
        start = stop
        pending = incidence[now] * b[now] - a[now] - c[now]
        summed = fixed_sum + incidence[now] * slope_sum + pending * pending_count
        variance[point] = summed @ summed
    size = len(pending_count)
    return np.sqrt(variance * size / (size - 1))


def _log_log_interval(share: Numbers, se: Numbers) -> tuple[Numbers, Numbers]:
    """Return the 95 % interval of shares; of 0 and of 1 (but for rounding) it is the share."""
    from scipy import stats

    inside = (share > 0) & (share < 1 - 1e-12)
    log = np.log(np.where(inside, share, 0.5))
    z = float(stats.norm.ppf((1 + LEVEL) / 2))
    factor = np.exp(z * se / np.where(inside, np.abs(share * log), 1.0))
    low, high = (np.where(inside, np.exp(log * to), share) for to in (factor, 1 / factor))
    return low, high
