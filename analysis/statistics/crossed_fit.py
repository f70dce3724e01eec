"""Maximum likelihood of the model with an arm, covariates and crossed random factors.

On the scale of the standard deviations themselves the likelihood is even in each of them, so a
variance that is estimated as 0 is an ordinary stationary point: the Hessian has no covariance
between it and the rest, whose standard errors are those of the model without it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .laplace import CrossedLikelihood
from .outcome import Clusters, Numbers

Flags = NDArray[np.bool_]
Descent = Callable[[Numbers], tuple[float, Numbers]]

_GRADIENT = 1e-4
"""Where the search ends; the Newton step that follows leaves about the square of it."""

_DIFFERENCE = 1e-4
"""Step of the central differences of the gradient: their errors are below 1e-7 of the Hessian."""

_LARGEST_STEP = 1e-2
"""A last Newton step beyond this, on the logit scale, means that the search ended too early."""

_REACH = 20.0
"""No standard deviation or effect beyond this is finite: it moves probabilities from 0 to 1."""


@dataclass(frozen=True, eq=False)
class CrossedFit:
    """Estimates on the logit scale at the maximum of the likelihood.

    `location`: log odds, halfway between the arms and at the covariates' means, of any category
    above the first; `effect`: log odds ratio of higher categories, treatment against reference;
    `sds`, shape (F,): standard deviations of the factors' effects. `covariance`, shape (2 + F,
    2 + F): of location, effect and sds, 0 for those held at 0. `covariates`, shape (K,): log odds
    ratios of one unit more of each, `covariate_ses` their standard errors. `at`, `hessian`: where
    the search ended, covariates in standard deviations, and the curvature there.
    """

    location: float
    effect: float
    sds: Numbers
    covariance: Numbers
    covariates: Numbers
    covariate_ses: Numbers
    log_likelihood: float
    at: Numbers
    hessian: Numbers


class CrossedModel:
    """The model category ~ arm + covariates + random factors, of one measure.

    `category` in 0..C-1, none empty, C > 1; `treated` both true and false; `factors`: numbers
    from 0 of the levels of each trial, or None for a factor whose standard deviation is held at 0;
    all of shape (N,). `covariates`, shape (N, K), None for none: columns that are no linear
    combination of a constant, the arm and each other.
    """

    def __init__(
        self,
        category: NDArray[np.int64],
        treated: Flags,
        factors: Sequence[Clusters | None],
        covariates: Numbers | None = None,
    ) -> None:
        levels = [np.zeros_like(category) if each is None else each for each in factors]
        sds = np.where([each is None for each in factors], 0.0, 0.5)
        if covariates is None:
            covariates = np.empty((len(category), 0))
        self._scales = covariates.std(axis=0)
        scaled = (covariates - covariates.mean(axis=0)) / self._scales
        fixed = np.column_stack([np.where(treated, 0.5, -0.5), scaled])
        self._likelihood = CrossedLikelihood(category, fixed, levels)
        start = _independent(category, treated)
        self._start = np.concatenate([start, np.zeros(scaled.shape[1]), sds])
        self._effect = int(category.max())
        self._first_sd = len(start) + scaled.shape[1]
        self._free = np.concatenate([np.full(self._first_sd, True), sds > 0])

    def fit(self) -> CrossedFit | None:
        """Return the estimates; None if the search finds no finite maximum."""
        descent = self._descent(self._start, self._free)
        start = self._start[self._free]
        end = _search(descent, start, _hessian(descent, start))
        if np.abs(end).max() > _REACH:
            return None
        hessian = _hessian(descent, end)
        if np.linalg.eigvalsh(hessian)[0] <= 0:
            return None
        step = np.linalg.solve(hessian, -descent(end)[1])
        if np.abs(step).max() > _LARGEST_STEP:
            return None
        at = self._start.copy()
        at[self._free] = end + step
        return self._fitted(at, hessian, -descent(end + step)[0])

    def log_likelihood_without_effect(self, fit: CrossedFit) -> float:
        """Return the maximum of the log-likelihood at effect 0, found from that with an effect."""
        free = self._free.copy()
        free[self._effect] = False
        start = np.where(free, fit.at, 0.0)
        descent = self._descent(start, free)
        kept = free[self._free]
        return -descent(_search(descent, start[free], fit.hessian[np.ix_(kept, kept)]))[0]

    def _fitted(self, at: Numbers, hessian: Numbers, log_likelihood: float) -> CrossedFit:
        """Read estimates and covariance off the parameters; the sign of an sd has no meaning."""
        everything = np.zeros((len(at), len(at)))
        everything[np.ix_(self._free, self._free)] = np.linalg.inv(hessian)
        reported = np.r_[0, self._effect, self._first_sd : len(at)]
        signs = np.concatenate([[-1.0, 1.0], np.where(at[self._first_sd :] < 0, -1.0, 1.0)])
        location, effect, *sds = signs * at[reported]
        beside = slice(self._effect + 1, self._first_sd)
        return CrossedFit(
            location=float(location),
            effect=float(effect),
            sds=np.array(sds),
            covariance=everything[np.ix_(reported, reported)] * np.outer(signs, signs),
            covariates=at[beside] / self._scales,
            covariate_ses=np.sqrt(np.diag(everything)[beside]) / self._scales,
            log_likelihood=log_likelihood,
            at=at,
            hessian=hessian,
        )

    def _descent(self, start: Numbers, free: Flags) -> Descent:
        """Return minus log-likelihood and gradient as a function of the free parameters.

        All parameters: first threshold, log gaps between thresholds, effect, covariates, sds.
        """

        def descent(values: Numbers) -> tuple[float, Numbers]:
            at = start.copy()
            at[free] = values
            gaps = np.exp(np.clip(at[1 : self._effect], -_REACH, _REACH))
            thresholds = at[0] + np.concatenate([[0.0], np.cumsum(gaps)])
            fixed, sds = at[self._effect : self._first_sd], at[self._first_sd :]
            slopes = self._likelihood(thresholds, fixed, sds)
            by_shift = np.cumsum(slopes.thresholds[::-1])[::-1]
            gradient = np.concatenate(
                [by_shift[:1], by_shift[1:] * gaps, slopes.slopes, slopes.sds]
            )
            return -slopes.value, -gradient[free]

        return descent


def _independent(category: NDArray[np.int64], treated: Flags) -> Numbers:
    """Return first threshold, log gaps and effect, roughly, as if trials were independent."""
    sizes = category.max() + 1
    counts = np.stack([np.bincount(category[arm], minlength=sizes) for arm in (~treated, treated)])
    below = np.cumsum(counts, axis=1)[:, :-1] + 0.5
    reference, treatment = np.log(below / (counts.sum(axis=1, keepdims=True) + 1 - below))
    thresholds = (reference + treatment) / 2
    gaps, effect = np.diff(thresholds), (reference - treatment).mean()
    return np.concatenate([thresholds[:1], np.log(gaps), [effect]])


def _search(descent: Descent, start: Numbers, hessian: Numbers) -> Numbers:
    """Return where descending from `start` ends, steps scaled by a Hessian made positive."""
    from scipy import optimize

    sizes, axes = np.linalg.eigh(hessian)
    sizes = np.maximum(np.abs(sizes), 1e-2 * np.abs(sizes).max())
    scaled = axes / np.sqrt(sizes)
    result = optimize.minimize(
        descent,
        start,
        jac=True,
        method="BFGS",
        options={"gtol": _GRADIENT, "hess_inv0": scaled @ scaled.T},
    )
    end: Numbers = result.x
    return end


def _hessian(descent: Descent, at: Numbers) -> Numbers:
    """Return the matrix of second derivatives, by central differences of the gradient."""
    steps = _DIFFERENCE * np.eye(len(at))
    rows = [(descent(at + h)[1] - descent(at - h)[1]) / (2 * _DIFFERENCE) for h in steps]
    matrix = np.stack(rows)
    return (matrix + matrix.T) / 2
