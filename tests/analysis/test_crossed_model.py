"""Simulated trials: shares and AUC that were asked for, effects where they belong."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import integrate, stats

from analysis import AnalysisError
from analysis.crossed_model import (
    CONFIDENCE_COUNTS,
    Design,
    Spread,
    confidence_model,
    correct_model,
    simulate,
)

SPREAD = Spread(0.8, 0.8, 0.4)
NONE = Spread(0, 0, 0)
LARGE = Design(participants=3000, trials_each=10, scenarios=1000)


def drawn(model, design, seed=1):
    return simulate(model, design, np.random.default_rng(seed))


def marginal_share(threshold, sd):
    """Chance that normal plus logistic noise exceeds a threshold, by adaptive quadrature."""
    return integrate.quad(
        lambda x: stats.norm.pdf(x, 0, sd) * stats.logistic.sf(threshold - x), -12 * sd, 12 * sd
    )[0]


def scenario_means(outcome, arm):
    of_arm = outcome.treated == arm
    scenario = outcome.scenario[of_arm]
    return np.bincount(scenario, outcome.y[of_arm]) / np.bincount(scenario)


@pytest.mark.parametrize("sd", [0.1, 1, 3])
def test_the_shares_asked_for_hold_over_all_people_and_scenarios(sd):
    model = correct_model(Spread(sd, 0, 0), 0.85, 0.70)
    (threshold,) = model.thresholds
    assert marginal_share(threshold, sd) == pytest.approx(0.70, abs=1e-7)
    assert marginal_share(threshold - model.shift, sd) == pytest.approx(0.85, abs=1e-7)


def test_without_spread_the_model_is_plain_logistic():
    model = correct_model(NONE, 0.85, 0.70)
    assert model.thresholds == pytest.approx((-np.log(0.70 / 0.30),))
    assert model.shift == pytest.approx(np.log(0.85 / 0.15) - np.log(0.70 / 0.30))


def test_simulated_trials_show_the_shares_asked_for():
    outcome = drawn(correct_model(SPREAD, 0.85, 0.70), LARGE)
    assert outcome.y[outcome.treated].mean() == pytest.approx(0.85, abs=0.015)
    assert outcome.y[~outcome.treated].mean() == pytest.approx(0.70, abs=0.02)


def test_simulated_confidence_shows_the_papers_answers_and_the_auc_asked_for():
    outcome = drawn(confidence_model(SPREAD, 0.6), LARGE)
    treatment, reference = outcome.y[outcome.treated], outcome.y[~outcome.treated]
    shares = np.bincount(reference.astype(int), minlength=8)[1:] / len(reference)
    assert shares == pytest.approx(np.array(CONFIDENCE_COUNTS) / 520, abs=0.02)
    u = stats.mannwhitneyu(treatment, reference).statistic
    assert u / (len(treatment) * len(reference)) == pytest.approx(0.6, abs=0.02)


def test_an_auc_of_a_half_is_no_shift():
    assert confidence_model(SPREAD, 0.5).shift == pytest.approx(0, abs=1e-9)


def test_a_scenarios_effect_is_shared_by_the_arms_and_its_interaction_is_not():
    design = Design(participants=3000, trials_each=10, scenarios=30)
    shared = drawn(correct_model(Spread(0, 2, 0), 0.7, 0.7), design)
    apart = drawn(correct_model(Spread(0, 0, 2), 0.7, 0.7), design)
    for outcome, low, high in ((shared, 0.95, 1), (apart, -0.5, 0.5)):
        means = [scenario_means(outcome, arm) for arm in (True, False)]
        assert np.std(means[0]) > 0.2
        assert low <= np.corrcoef(means)[0, 1] <= high


def test_participants_differ_by_their_own_effect_only():
    design = Design(participants=400, trials_each=30, scenarios=30)
    for sd, least, most in ((0, 0.06, 0.1), (2, 0.25, 0.4)):
        outcome = drawn(correct_model(Spread(sd, 0, 0), 0.7, 0.7), design)
        between = np.std(np.bincount(outcome.participant, outcome.y) / 30)
        assert least < between < most


@given(
    half=st.integers(1, 30), scenarios=st.integers(1, 40), data=st.data(), seed=st.integers(0, 99)
)
@settings(max_examples=40)
def test_scenarios_are_dealt_evenly_and_nobody_sees_one_twice(half, scenarios, data, seed):
    trials_each = data.draw(st.integers(1, scenarios))
    design = Design(2 * half, trials_each, scenarios)
    outcome = drawn(correct_model(NONE, 0.5, 0.5), design, seed)
    pairs = np.column_stack([outcome.participant, outcome.scenario])
    assert len(np.unique(pairs, axis=0)) == len(pairs) == 2 * half * trials_each
    for arm in (True, False):
        uses = np.bincount(outcome.scenario[outcome.treated == arm], minlength=scenarios)
        assert uses.max() - uses.min() <= 1


def test_the_same_seed_gives_the_same_trials_and_another_does_not():
    model, design = confidence_model(SPREAD), Design(20)
    first, again, other = (drawn(model, design, seed) for seed in (3, 3, 4))
    assert (first.y == again.y).all()
    assert (first.scenario == again.scenario).all()
    assert (first.y != other.y).any()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Spread(0.8, -1, 0), "expected 0 to 5 on the logit scale, got -1"),
        (lambda: Spread(float("nan"), 0, 0), "got nan"),
        (lambda: Design(41), "expected an even number from 2, got 41"),
        (lambda: Design(40, 38, 37), "expected 1 to 37"),
        (lambda: correct_model(NONE, 1, 0.7), "expected .001 to .999, got 1"),
        (lambda: confidence_model(NONE, 0.8), "expected .05 to .75, got 0.8"),
    ],
)
def test_what_cannot_be_simulated_is_one_clear_error(make, message):
    with pytest.raises(AnalysisError, match=message):
        make()
