"""The Laplace likelihood against dense matrices, its own differences, brute-force integrals."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import integrate, stats
from scipy.special import expit

from analysis.statistics.crossed_precision import Crossing
from analysis.statistics.laplace import CrossedLikelihood

THRESHOLDS = {2: np.array([-0.3]), 4: np.array([-1.1, 0.2, 0.9])}
SEEDS = st.integers(0, 2**32 - 1)


def crossed(seed, categories, participants=6, scenarios=4, trials=40):
    """Trials dealt at random; every category and level occurs."""
    rng = np.random.default_rng(seed)
    deal = [
        rng.permutation(np.arange(trials) % size) for size in (categories, participants, scenarios)
    ]
    x = rng.integers(0, 2, trials) - 0.5
    category, participant, scenario = deal
    cells = np.unique(2 * scenario + (x > 0), return_inverse=True)[1]
    return category, np.stack([x, rng.normal(size=trials)], axis=1), (participant, scenario, cells)


@given(SEEDS)
@settings(max_examples=20)
def test_the_blocks_are_those_of_the_whole_precision_matrix(seed):
    _, _, factors = crossed(seed, 2)
    rng = np.random.default_rng(seed)
    crossing = Crossing(factors)
    weights, sds = rng.random(40), np.array([0.8, 0.0, 1.3])
    Z = np.zeros((40, len(crossing.factor)))
    for positions in crossing.positions:
        Z[np.arange(40), positions] = 1
    Z *= sds[crossing.factor]
    H = np.eye(len(crossing.factor)) + Z.T @ (weights[:, None] * Z)
    precision = crossing.precision(weights, sds)
    right = rng.normal(size=len(H))
    assert precision.log_determinant == pytest.approx(np.linalg.slogdet(H).logabsdet)
    assert precision.solve(right) == pytest.approx(np.linalg.solve(H, right))
    inverse, positions = np.linalg.inv(H), crossing.positions
    assert precision.covariances() == pytest.approx(inverse[positions[:, None], positions])


@pytest.mark.parametrize("categories", [2, 4])
@given(SEEDS)
@settings(max_examples=20)
def test_the_gradient_is_that_of_differences(categories, seed):
    likelihood = CrossedLikelihood(*crossed(seed, categories))
    cuts = categories - 1

    def value(at):
        return likelihood(at[:cuts], at[cuts : cuts + 2], at[cuts + 2 :]).value

    at = np.concatenate([THRESHOLDS[categories], [0.7, -0.2, 0.9, 0.0, 0.4]])
    found = likelihood(at[:cuts], at[cuts : cuts + 2], at[cuts + 2 :])
    steps = 1e-5 * np.eye(len(at))
    expected = [(value(at + h) - value(at - h)) / 2e-5 for h in steps]
    gradient = [*found.thresholds, *found.slopes, *found.sds]
    assert gradient == pytest.approx(expected, abs=1e-5)


def test_without_random_effects_it_is_the_likelihood_of_independent_trials():
    category, x, factors = crossed(1, 4)
    thresholds, slopes = THRESHOLDS[4], np.array([0.7, -0.2])
    below = expit(np.concatenate([[-np.inf], thresholds, [np.inf]])[:, None] - x @ slopes)
    shares = np.diff(below, axis=0)[category, np.arange(len(x))]
    found = CrossedLikelihood(category, x, factors)(thresholds, slopes, np.zeros(3))
    assert found.value == pytest.approx(np.log(shares).sum(), abs=1e-12)


@pytest.mark.parametrize(("repeats", "error"), [(5, 0.04), (20, 0.025)])
def test_it_comes_close_to_the_integral_over_four_crossed_effects(repeats, error):
    """Two participants by two scenarios: a sum over 27^4 points, good to 1e-6."""
    pairs = np.array(list(itertools.product([0, 1], [0, 1])))
    correct = np.array([1, 2, 2, 4]) * repeats // 5
    category = np.concatenate([np.arange(repeats) < each for each in correct]).astype(np.int64)
    factors = list(np.repeat(pairs, repeats, axis=0).T)
    sds = np.array([0.8, 0.6])
    nothing = np.zeros((4 * repeats, 1))
    likelihood = CrossedLikelihood(category, nothing, factors)
    laplace = likelihood(np.array([0.2]), np.zeros(1), sds)
    nodes, weights = np.polynomial.hermite_e.hermegauss(27)
    effects = np.array(np.meshgrid(*[nodes] * 4)).reshape(2, 2, -1)
    masses = np.array(np.meshgrid(*[weights / weights.sum()] * 4)).reshape(4, -1)
    likelihood = np.prod(masses, axis=0)
    for count, (participant, scenario) in zip(correct, pairs, strict=True):
        share = expit(sds[0] * effects[0, participant] + sds[1] * effects[1, scenario] - 0.2)
        likelihood *= share**count * (1 - share) ** (repeats - count)
    assert 0 < np.log(likelihood.sum()) - laplace.value < error


@pytest.mark.parametrize(("trials", "error"), [(10, 2e-2), (40, 1e-2), (160, 3e-3), (640, 7e-4)])
def test_it_is_closer_the_more_trials_an_effect_has(trials, error):
    """One participant, so the likelihood is one integral; the error falls as 1 / trials."""
    category = (np.arange(trials) % 10 < 8).astype(np.int64)
    nobody = np.zeros(trials, dtype=np.int64)
    found = CrossedLikelihood(category, np.zeros((trials, 1)), [nobody, nobody])(
        np.array([0.0]), np.zeros(1), np.array([1.5, 0.0])
    )
    correct = category.sum()

    def density(u):
        share = expit(1.5 * u)
        return share**correct * (1 - share) ** (trials - correct) * stats.norm.pdf(u)

    exact = np.log(integrate.quad(density, -8, 8, points=[0.9], epsabs=0, epsrel=1e-10)[0])
    assert 0 < abs(found.value - exact) < error
