"""How probable it is that one arm guesses right more often, from participants' counts.

A participant's share of right guesses is drawn from a beta distribution of the arm, with mean mu
and intraclass correlation rho: counts are beta-binomial. Own code: no package of ours has the model
with an unknown correlation, and two numbers an arm need no sampler.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .outcome import Numbers, Outcome
from .participants import by_participant

PRIORS = (
    "mean share and correlation of a participant's guesses each uniform from 0 to 1, independent "
    "between the arms"
)

_REACH = 40.0
"""Logits from the mode to where nothing is left: both priors fall by e^-1 a logit."""

_STEP = 0.05
"""Between nodes, in units of the posterior's width near the mode: errors are below 1e-7."""

_DIFFERENCE = 1e-3
"""Of the second differences, in logits."""


@dataclass(frozen=True, kw_only=True)
class Superiority:
    """The posterior `probability` that the treatment's mean share exceeds the reference's.

    `share_*` and `correlation_*` are posterior means of an arm's mean share of right guesses, and
    of the correlation of two guesses of a participant; `participants_*` is how many an arm has.
    """

    probability: float
    share_treatment: float
    share_reference: float
    correlation_treatment: float
    correlation_reference: float
    participants_treatment: int
    participants_reference: int
    priors: str = PRIORS
    method: str = "beta-binomial counts of participants, posterior by quadrature"
    source: str = "Skellam (1948), Journal of the Royal Statistical Society B 10, 257-261"


@dataclass(frozen=True, eq=False)
class _Posterior:
    """An arm's share on the logit scale: `density`, shape (N,), over even steps of t.

    The logit is `mode` + `width` sinh(t): dense near the mode, and far-reaching.
    """

    mode: float
    width: float
    t: Numbers
    density: Numbers
    correlation: float

    @property
    def logits(self) -> Numbers:
        """The logits of the nodes."""
        logits: Numbers = self.mode + self.width * np.sinh(self.t)
        return logits

    @property
    def share(self) -> float:
        """Posterior mean."""
        from scipy.special import expit

        return float(expit(self.logits) @ self.density / self.density.sum())

    def below(self, logits: Numbers) -> Numbers:
        """Return the probability that the share's logit is below each."""
        from scipy.interpolate import CubicSpline

        cumulative = CubicSpline(self.t, self.density).antiderivative()
        at = np.clip(np.arcsinh((logits - self.mode) / self.width), self.t[0], self.t[-1])
        share: Numbers = cumulative(at) / cumulative(self.t[-1])
        return share


def superiority(correct: Outcome) -> Superiority:
    """Return how probable a larger mean share in the treatment arm is, with the priors it names.

    `correct.y` is 1 or 0. Participants count as drawn from many, scenarios are left out of account.
    O(N + T) for T trials of the participant with most. EmptyArmError if an arm has no value.
    """
    people = by_participant(correct)
    treatment, reference = (
        _posterior(people.sums[arm], people.trials[arm].astype(np.float64))
        for arm in (people.treated, ~people.treated)
    )
    # the wider one's distribution is smooth on the other's nodes
    if treatment.width <= reference.width:
        probability = _mean(reference.below(treatment.logits), treatment)
    else:
        probability = 1 - _mean(treatment.below(reference.logits), reference)
    return Superiority(
        probability=probability,
        share_treatment=treatment.share,
        share_reference=reference.share,
        correlation_treatment=treatment.correlation,
        correlation_reference=reference.correlation,
        participants_treatment=int(people.treated.sum()),
        participants_reference=int((~people.treated).sum()),
    )


def _mean(values: Numbers, posterior: _Posterior) -> float:
    return float(values @ posterior.density / posterior.density.sum())


def _posterior(right: Numbers, trials: Numbers) -> _Posterior:
    """Return the posterior of an arm whose participants have `right` of `trials`, shape (P,)."""
    from scipy import optimize
    from scipy.special import expit, logit

    density = _LogDensity(right, trials)

    def descent(at: Numbers) -> float:
        return -float(density(at[0], at[1]))

    start = np.array([float(logit((right.sum() + 1) / (trials.sum() + 2))), -2.0])
    mode: Numbers = optimize.minimize(descent, start, method="Nelder-Mead").x
    widths = [density.width(mode, axis) for axis in (0, 1)]
    (t, y, dy), (_, x, dx) = (_nodes(at, width) for at, width in zip(mode, widths, strict=True))
    joint = density(y[:, None], x)
    weights = np.exp(joint - joint.max()) * dy[:, None] * dx
    by_correlation = weights.sum(axis=0)
    return _Posterior(
        mode=float(mode[0]),
        width=widths[0],
        t=t,
        density=weights.sum(axis=1),
        correlation=float(expit(x) @ by_correlation / by_correlation.sum()),
    )


def _nodes(mode: float, width: float) -> tuple[Numbers, Numbers, Numbers]:
    """Return even steps of t, the logits there and their derivatives by t."""
    half = int(np.ceil(np.arcsinh(_REACH / width) / _STEP))
    t: Numbers = _STEP * np.arange(-half, half + 1, dtype=np.float64)
    return t, mode + width * np.sinh(t), width * np.cosh(t)


class _LogDensity:
    """The log posterior of an arm, at logits of the mean share and of the correlation.

    With theta = rho / (1 - rho), the likelihood of k of n is the product of mu + j theta for j < k,
    of 1 - mu + j theta for j < n - k, over that of 1 + j theta for j < n: each factor is raised to
    the number of participants who have it.
    """

    def __init__(self, right: Numbers, trials: Numbers) -> None:
        steps = np.arange(int(trials.max()))
        self._powers = [
            (each > steps[:, None]).sum(axis=1) for each in (right, trials - right, trials)
        ]

    def __call__(self, share: Numbers | float, correlation: Numbers | float) -> Numbers:
        """Return it without its constant, arguments broadcast."""
        from scipy.special import expit, log_expit

        mu, rest, theta = expit(share), expit(-np.asarray(share)), np.exp(correlation)
        total = log_expit(share) + log_expit(-np.asarray(share))
        total = total + log_expit(correlation) + log_expit(-np.asarray(correlation))
        for j, (right, wrong, both) in enumerate(zip(*self._powers, strict=True)):
            total = total + right * np.log(mu + j * theta) + wrong * np.log(rest + j * theta)
            total = total - both * np.log1p(j * theta)
        return np.asarray(total)

    def width(self, mode: Numbers, axis: int) -> float:
        """Return the standard deviation along an axis that the curvature at the mode implies."""
        step = _DIFFERENCE * np.eye(2)[axis]
        before, at, after = (self(*(mode + shift)) for shift in (-step, 0 * step, step))
        return float(_DIFFERENCE / np.sqrt(2 * at - before - after))
