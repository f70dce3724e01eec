"""The partial likelihood of Cox regression on the arm and whatever else is known of a trial.

Own code: statsmodels' PHReg and lifelines' CoxPHFitter estimate the same, but take half a minute
for 100,000 trials; here every sum over the trials at risk is a cumulative sum over times.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .outcome import Numbers

_CLOSE = 1e-20
"""Squared length of a Newton step, in standard errors, that is not worth taking."""
_MOST_STEPS = 100
_REACH = 10.0
"""No finite log hazard ratio of a standard deviation is larger: that of two arms is at most of the
order of log N, for which a standard deviation is a half or less."""


@dataclass(frozen=True, eq=False)
class CoxFit:
    """Log hazard ratios of K columns, shape (K,), and their `naive` covariance, shape (K, K).

    `influence`, shape (N, K): by how much each trial moves them, its score residual times the
    naive covariance; every column sums to 0.
    """

    coefficients: Numbers
    naive: Numbers
    influence: Numbers


class _Sums(NamedTuple):
    """Of the E correct stops: hazard's denominator, shape (E,), mean of x at risk, shape (E, K)."""

    rate: Numbers
    mean: Numbers


class CoxLikelihood:
    """Efron's partial likelihood of N trials.

    `time_s`, `event` of shape (N,): when each ended, and whether by the event; `x`, shape (N, K).
    U different times have events. A term for each of E events: `_at`, number of its time, and
    `_gone`, the share of the events tied with it that Efron counts as over.
    """

    def __init__(self, time_s: Numbers, event: NDArray[np.bool_], x: Numbers) -> None:
        times_s, number, events = np.unique(time_s[event], return_inverse=True, return_counts=True)
        self._event, self._x, self._number, self._events = event, x, number, events
        self._at = np.repeat(np.arange(len(times_s)), events)
        self._gone = np.arange(len(self._at)) - (np.cumsum(events) - events)[self._at]
        self._gone = self._gone / events[self._at]
        self._passed = np.searchsorted(times_s, time_s, side="right")

    def is_separated(self, treated: NDArray[np.bool_]) -> bool:
        """Tell whether the likelihood has no maximum in the hazard ratio of two arms alone."""
        treatment, reference = (
            self._at_risk(each.astype(np.float64)) for each in (treated, ~treated)
        )
        of_treated = int((self._event & treated).sum())
        return of_treated in (int((reference == 0).sum()), int((treatment > 0).sum()))

    def fit(self) -> CoxFit | None:
        """Return the maximum, by Newton's method with halved steps; None if there is none."""
        at, scale = np.zeros(self._x.shape[1]), self._x.std(axis=0)
        value, score, information = self._slopes(at)
        for _ in range(_MOST_STEPS):
            if np.abs(at * scale).max() > _REACH or not np.linalg.det(information) > 0:
                return None
            step = np.linalg.solve(information, score)
            if score @ step < _CLOSE:
                naive = np.linalg.inv(information).astype(np.float64, copy=False)
                return CoxFit(at, naive, self._score_residuals(at) @ naive)
            further = self._slopes(at + step)
            while further[0] < value - 1e-9 * abs(value):
                step = step / 2
                further = self._slopes(at + step)
            at, (value, score, information) = at + step, further
        return None

    def _slopes(self, at: Numbers) -> tuple[float, Numbers, Numbers]:
        """Return log-likelihood, score, shape (K,), and information, shape (K, K)."""
        weight = np.exp(self._x @ at)
        rate, mean = self._sums(weight)
        events = self._x[self._event].sum(axis=0)
        squares = np.empty((len(at), len(at)))
        for i, j in np.ndindex(squares.shape):
            product = self._x[:, i] * self._x[:, j]
            squares[i, j] = (self._at_risk(weight * product) / rate).sum()
        value = float(events @ at - np.log(rate).sum())
        return value, events - mean.sum(axis=0), squares - mean.T @ mean

    def _sums(self, weight: Numbers) -> _Sums:
        rate = self._at_risk(weight)
        columns = [self._at_risk(weight * column) / rate for column in self._x.T]
        return _Sums(rate, np.stack(columns, axis=1))

    def _at_risk(self, values: Numbers) -> Numbers:
        """Return the sum of values over who is at risk at each event, less the share gone, (E,)."""
        there = self._by_passed(values)
        here = np.bincount(self._number, values[self._event], len(self._events))
        found: Numbers = there[self._at] - self._gone * here[self._at]
        return found

    def _by_passed(self, values: Numbers) -> Numbers:
        """Return the sum of values over the trials that end at each time or later, shape (U,)."""
        ending = np.bincount(self._passed, values, len(self._events) + 1)
        there: Numbers = np.cumsum(ending[:0:-1], dtype=np.float64)[::-1]
        return there

    def _score_residuals(self, at: Numbers) -> Numbers:
        """Return each trial's share in the score, shape (N, K); they sum to 0 at the maximum."""
        weight = np.exp(self._x @ at)
        rate, mean = self._sums(weight)
        size = len(self._events)
        hazard = np.append(0.0, np.cumsum(np.bincount(self._at, 1 / rate, size)))[self._passed]
        tied = np.bincount(self._at, self._gone / rate, size)[self._number]
        residuals = np.empty_like(self._x)
        for column, x, of_mean in zip(residuals.T, self._x.T, mean.T, strict=True):
            pull = np.append(0.0, np.cumsum(np.bincount(self._at, of_mean / rate, size)))
            column[:] = -weight * (x * hazard - pull[self._passed])
            own = np.bincount(self._at, of_mean, size) / self._events
            gone = np.bincount(self._at, self._gone * of_mean / rate, size)
            stopped, number = self._event, self._number
            column[stopped] += x[stopped] - own[number]
            column[stopped] += weight[stopped] * (x[stopped] * tied - gone[number])
        return residuals
