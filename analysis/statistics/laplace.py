"""Laplace's approximation to the likelihood of crossed random effects on a logit scale.

Trial i falls into category c of 0..C-1 with P(c <= k) = F(alpha_k - eta_i), F the logistic function
and alpha increasing; eta_i = slopes . x_i + sum over factors f of sd_f u[level of i in f], all u
standard normal. Two categories make the logistic model with intercept -alpha_0; more make the
cumulative logit model.

Because F(a) - F(b) = F(a) (1 - F(b)) (1 - exp(b - a)), the log-likelihood of a trial is a term of
its upper bound, a term of its lower one, and one that does not depend on eta: each derivative has
two terms. The approximation uses the observed information, as R's lme4 (nAGQ = 1), glmmTMB and
ordinal do; its gradient is exact, with the modes' dependence on the parameters (Kristensen and
others (2016), Journal of Statistical Software 70(5)).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .crossed_precision import Crossing, Precision
from .outcome import Clusters, Numbers

_MOST_STEPS = 100
_CLOSE = 1e-18
"""Squared length of a Newton step, in units of the curvature, that is not worth taking."""


class Slopes(NamedTuple):
    """A log-likelihood and its derivatives by thresholds (C-1,), slopes (K,) and sds (F,)."""

    value: float
    thresholds: Numbers
    slopes: Numbers
    sds: Numbers


class _Bounds(NamedTuple):
    """F and its derivative at both bounds of N trials' categories, less eta, shape (2, N)."""

    share: Numbers
    density: Numbers
    log_likelihood: float

    @property
    def score(self) -> Numbers:
        """Derivative of each trial's log-likelihood by eta, at each bound."""
        score: Numbers = self.share - np.array([[0.0], [1.0]])
        return score

    @property
    def curvature(self) -> Numbers:
        """Third derivative of each trial's log-likelihood by eta, at each bound."""
        return self.density * (1 - 2 * self.share)


class CrossedLikelihood:
    """The log-likelihood of N trials, a function of thresholds, slopes and standard deviations.

    `category`, shape (N,), in 0..C-1, none empty; `x`, shape (N, K): any K fixed effects;
    `factors`: numbers from 0 of the levels of each trial, each of shape (N,), the factor with most
    levels first. It remembers the modes it found, to start from them.
    """

    def __init__(
        self, category: NDArray[np.int64], x: Numbers, factors: Sequence[Clusters]
    ) -> None:
        self.category, self.x = category, x
        self.counts = np.bincount(category)
        self.crossing = Crossing(factors)
        self._mode = np.zeros(len(self.crossing.factor))

    def __call__(self, thresholds: Numbers, slopes: Numbers, sds: Numbers) -> Slopes:
        """Return log-likelihood and derivatives; at sd 0 its derivative is 0."""
        scale = sds[self.crossing.factor]
        bounds, precision = self._find_mode(thresholds, slopes, sds)
        mode = self._mode
        covariances = np.einsum("g,fgn->fn", sds, precision.covariances())
        variance = sds @ covariances
        # The modes move with the parameters, and the log-determinant with the modes: tilt is its
        # derivative by the modes, carried back through the equation that defines them.
        tilt = precision.solve(scale * self.crossing.sums(variance * bounds.curvature.sum(axis=0)))
        shift = self.crossing.totals(scale * tilt)
        score = bounds.score + (variance * bounds.curvature - shift * bounds.density) / 2
        per_level = mode * self.crossing.sums(score.sum(axis=0))
        per_level += tilt * self.crossing.sums(bounds.score.sum(axis=0)) / 2
        return Slopes(
            float(bounds.log_likelihood - mode @ mode / 2 - precision.log_determinant / 2),
            self._by_threshold(score, thresholds),
            score.sum(axis=0) @ self.x,
            np.bincount(self.crossing.factor, per_level) - covariances @ bounds.density.sum(axis=0),
        )

    def _find_mode(
        self, thresholds: Numbers, slopes: Numbers, sds: Numbers
    ) -> tuple[_Bounds, Precision]:
        """Leave the most probable effects in `_mode`, by Newton's method with halved steps.

        The joint density is log-concave in them: there is one mode, and every start finds it.
        """
        scale, fixed = sds[self.crossing.factor], self.x @ slopes
        u = self._mode
        bounds = self._bounds(thresholds, fixed + self.crossing.totals(scale * u))
        for _ in range(_MOST_STEPS):
            precision = self.crossing.precision(bounds.density.sum(axis=0), sds)
            gradient = scale * self.crossing.sums(bounds.score.sum(axis=0)) - u
            step = precision.solve(gradient)
            decrement = gradient @ step
            if decrement < _CLOSE:
                break
            best = bounds.log_likelihood - u @ u / 2
            for _ in range(_MOST_STEPS):
                further = u + step
                bounds = self._bounds(thresholds, fixed + self.crossing.totals(scale * further))
                if bounds.log_likelihood - further @ further / 2 >= best - 1e-9 * abs(best):
                    break
                step = step / 2
            u = further
        self._mode = u
        return bounds, precision

    def _bounds(self, thresholds: Numbers, eta: Numbers) -> _Bounds:
        from scipy.special import expit, log_expit

        edges = np.concatenate([[-np.inf], thresholds, [np.inf]])
        lower, upper = edges[self.category] - eta, edges[self.category + 1] - eta
        between = self.counts @ np.log(-np.expm1(-np.diff(edges)))
        share = expit(np.stack([lower, upper]))
        outside = log_expit(-lower).sum() + log_expit(upper).sum()
        return _Bounds(share, share * (1 - share), float(outside + between))

    def _by_threshold(self, score: Numbers, thresholds: Numbers) -> Numbers:
        """Derivatives by the thresholds, from those by eta at each bound."""
        lower, upper = (np.bincount(self.category, each) for each in score)
        gaps = np.diff(thresholds, prepend=-np.inf, append=np.inf)
        pull = self.counts * np.exp(-gaps) / -np.expm1(-gaps)
        return pull[:-1] - pull[1:] - upper[:-1] - lower[1:]
