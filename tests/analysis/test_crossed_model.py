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
    halves,
    simulate,
)

SPREAD = Spread(0.8, 0.8, 0.4)
NONE = Spread(0, 0, 0)
LARGE = halves(3000, trials_each=10, scenarios=1000)


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
    design = halves(3000, trials_each=10, scenarios=30)
    shared = drawn(correct_model(Spread(0, 2, 0), 0.7, 0.7), design)
    apart = drawn(correct_model(Spread(0, 0, 2), 0.7, 0.7), design)
    for outcome, low, high in ((shared, 0.95, 1), (apart, -0.5, 0.5)):
        means = [scenario_means(outcome, arm) for arm in (True, False)]
        assert np.std(means[0]) > 0.2
        assert low <= np.corrcoef(means)[0, 1] <= high


def test_participants_differ_by_their_own_effect_only():
    design = halves(400, trials_each=30, scenarios=30)
    for sd, least, most in ((0, 0.06, 0.1), (2, 0.25, 0.4)):
        outcome = drawn(correct_model(Spread(sd, 0, 0), 0.7, 0.7), design)
        between = np.std(np.bincount(outcome.participant, outcome.y) / 30)
        assert least < between < most


@given(
    treatment=st.integers(1, 30),
    reference=st.integers(1, 30),
    trials_each=st.integers(1, 40),
    scenarios=st.integers(1, 40),
    seed=st.integers(0, 99),
)
@settings(max_examples=40)
def test_scenarios_are_dealt_evenly_and_all_are_seen_before_one_again(
    treatment, reference, trials_each, scenarios, seed
):
    design = Design(treatment, reference, trials_each, scenarios)
    outcome = drawn(correct_model(NONE, 0.5, 0.5), design, seed)
    seen = np.zeros((design.participants, scenarios))
    np.add.at(seen, (outcome.participant, outcome.scenario), 1)
    assert (seen.sum(axis=1) == trials_each).all()
    assert (seen.max(axis=1) - seen.min(axis=1) <= 1).all()
    for arm, size in ((True, treatment), (False, reference)):
        assert len(np.unique(outcome.participant[outcome.treated == arm])) == size
        uses = np.bincount(outcome.scenario[outcome.treated == arm], minlength=scenarios)
        assert uses.max() - uses.min() <= 1


def test_the_same_seed_gives_the_same_trials_and_another_does_not():
    model, design = confidence_model(SPREAD), halves(20)
    first, again, other = (drawn(model, design, seed) for seed in (3, 3, 4))
    assert (first.y == again.y).all()
    assert (first.scenario == again.scenario).all()
    assert (first.y != other.y).any()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Spread(0.8, -1, 0), "expected 0 to 5 on the logit scale, got -1"),
        (lambda: Spread(float("nan"), 0, 0), "got nan"),
        (lambda: halves(41), "expected an even number from 2, got 41"),
        (lambda: Design(0, 3), "participants in an arm: expected at least 1, got 0"),
        (lambda: Design(3, 3, 0), "trials per participant: expected at least 1, got 0"),
        (lambda: Design(3, 3, 10, 0), "scenarios: expected at least 1, got 0"),
        (lambda: correct_model(NONE, 1, 0.7), "expected .001 to .999, got 1"),
        (lambda: confidence_model(NONE, 0.8), "expected .05 to .75, got 0.8"),
    ],
)
def test_what_cannot_be_simulated_is_one_clear_error(make, message):
    with pytest.raises(AnalysisError, match=message):
        make()
