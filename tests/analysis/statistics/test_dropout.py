"""Leaving participants: compared between arms, and kept in the comparison."""

from dataclasses import replace

import numpy as np
import pytest
import statsmodels.api as sm
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats
from statsmodels.stats.sandwich_covariance import cov_cluster_2groups

from analysis.errors import EmptyArmError
from analysis.statistics.clustered import two_way_auc, two_way_difference
from analysis.statistics.dropout import completers, differential_dropout, intention_to_treat
from analysis.statistics.outcome import UNKNOWN, Outcome
from tests.analysis.statistics.cases import defined
from tests.analysis.statistics.outcomes import of_fixture

NAN = float("nan")


def people(left_treatment, stayed_treatment, left_reference, stayed_reference):
    """Two arrays of participants: whether treated, whether completed."""
    sizes = [left_treatment, stayed_treatment, left_reference, stayed_reference]
    return np.repeat([True, True, False, False], sizes), np.repeat(
        [False, True, False, True], sizes
    )


def trials():
    """Three trials of participant 0, one of 1 (both treated), two of 2, one of them without a y."""
    return Outcome(
        name="correct",
        unit="proportion",
        y=np.array([1.0, 0.0, 1.0, 1.0, NAN, 1.0]),
        treated=np.array([True, True, True, True, False, False]),
        participant=np.array([0, 0, 0, 1, 2, 2]),
        scenario=np.array([0, 1, 2, 1, 0, 2]),
    )


def test_golden_newcombe_of_those_who_left(golden):
    """Case newcombe_textbook: R fisher.test; Newcombe (1998) method 10."""
    case = golden("newcombe_textbook")
    (left, stayed), (other_left, other_stayed) = case["input"]["table"]
    test = differential_dropout(*people(left, stayed, other_left, other_stayed))
    expected = case["expected"]
    assert test.estimate == pytest.approx(expected["rd"], abs=case["tol"])
    assert [test.low, test.high] == pytest.approx(expected["rd_ci_newcombe"], abs=case["tol"])
    assert test.fisher_p == pytest.approx(expected["fisher_p"], abs=case["tol"])


def test_more_leaving_in_the_treatment_arm_is_positive_and_counted():
    test = differential_dropout(*people(6, 14, 1, 19))
    assert test.estimate == pytest.approx(0.25)
    assert (test.left_treatment, test.participants_treatment) == (6, 20)
    assert (test.left_reference, test.participants_reference) == (1, 20)
    assert (test.n, test.of) == (40, "participants")


@given(*[st.integers(1, 30)] * 4)
def test_p_is_fishers_and_swapping_the_arms_changes_the_sign(a, b, c, d):
    one = differential_dropout(*people(a, b, c, d))
    other = differential_dropout(*people(c, d, a, b))
    assert other.estimate is not None
    assert one.fisher_p == pytest.approx(stats.fisher_exact(np.array([[a, b], [c, d]])).pvalue)
    assert one.estimate == pytest.approx(-other.estimate)
    assert one.fisher_p == pytest.approx(other.fisher_p)


@pytest.mark.parametrize("counts", [(0, 9, 0, 7), (9, 0, 7, 0)])
def test_nobody_or_everybody_leaving_is_no_difference(counts):
    test = differential_dropout(*people(*counts))
    assert (test.estimate, test.fisher_p) == (0.0, 1.0)
    assert test.low is not None


def test_fishers_p_is_not_said_to_be_the_intervals():
    """Newcombe's interval of 6 of 10 against 1 of 10 excludes 0, Fisher's p is above .05.

    R 4.2.2: fisher.test(matrix(c(6, 4, 1, 9), 2, byrow = TRUE))$p.value.
    """
    test = differential_dropout(*people(6, 4, 1, 9))
    assert test.low is not None
    assert test.low > 0
    assert test.fisher_p == pytest.approx(0.0572755418)
    assert test.p is None


def test_an_arm_without_participants_is_an_error():
    with pytest.raises(EmptyArmError, match=r"condition reference: .* participant"):
        differential_dropout(*people(1, 2, 0, 0))


def test_completers_keep_all_their_trials_and_the_others_none():
    found = completers(trials(), np.array([True, False, True]))
    assert found.participant.tolist() == [0, 0, 0, 2, 2]
    assert found.scenario.tolist() == [0, 1, 2, 0, 2]
    assert found.treated.tolist() == [True, True, True, False, False]
    assert found.n_missing == 1


def test_intention_to_treat_counts_every_trial_dealt_to_whoever_played_one():
    found = intention_to_treat(trials(), trials_dealt=3, missing=0.0)
    assert np.bincount(found.participant).tolist() == [3, 3, 3]
    assert found.y[:6].tolist() == [1, 0, 1, 1, 0, 1]
    assert found.y[6:].tolist() == [0, 0, 0]
    assert found.treated[6:].tolist() == [True, True, False]
    assert found.n_missing == 0


def test_the_scenario_of_a_trial_never_reached_is_unknown():
    found = intention_to_treat(trials(), trials_dealt=3, missing=0.0)
    assert found.scenario.tolist() == [0, 1, 2, 1, 0, 2, UNKNOWN, UNKNOWN, UNKNOWN]


@pytest.fixture(scope="module")
def half_of_an_arm_left(paper_fixture):
    """Correct guesses of the synthetic trials; 26 of the 52 reference participants left after 3."""
    whole = of_fixture(paper_fixture, "correct")
    leavers = np.unique(whole.participant[~whole.treated])[:26]
    # rows are in the order of participants, ten each
    index = np.tile(np.arange(10), 150)
    stayed = ~np.isin(whole.participant, leavers) | (index < 3)
    return replace(
        whole,
        y=whole.y[stayed],
        treated=whole.treated[stayed],
        participant=whole.participant[stayed],
        scenario=whole.scenario[stayed],
    )


def test_trials_never_reached_vary_as_statsmodels_has_it_with_a_scenario_of_each_ones_own(
    half_of_an_arm_left,
):
    """statsmodels cov_cluster_2groups without corrections, for the least squares on the arm."""
    filled = intention_to_treat(half_of_an_arm_left, trials_dealt=10, missing=0.0)
    test = defined(two_way_difference(filled))
    unknown = filled.scenario == UNKNOWN
    own = np.where(unknown, 100 + np.arange(len(unknown)), filled.scenario)
    fit = sm.OLS(filled.y, sm.add_constant(filled.treated.astype(float))).fit()
    both, _, _ = cov_cluster_2groups(fit, filled.participant, own, use_correction=False)
    uncorrected = (
        test.v_participant * 149 / 150 + test.v_scenario * 36 / 37 - test.v_trial * 1317 / 1318
    )
    assert unknown.sum() == 182
    assert uncorrected == pytest.approx(both[1, 1], rel=1e-9)


def test_trials_never_reached_do_not_count_as_scenarios_nor_decide_the_test(half_of_an_arm_left):
    """As one cluster of 182 trials they took the standard error from .034 to .158."""
    seen = defined(two_way_difference(half_of_an_arm_left))
    filled = defined(two_way_difference(intention_to_treat(half_of_an_arm_left, 10, 0.0)))
    assert (filled.scenarios, filled.df) == (37, 36)
    assert seen.se < filled.se < 1.5 * seen.se
    assert filled.warnings == ()


@pytest.mark.parametrize("test", [two_way_difference, two_way_auc])
def test_trials_of_one_scenario_and_unknown_ones_are_trials_of_one_scenario(test):
    found = test(
        Outcome(
            name="correct",
            unit="share",
            y=np.array([1.0, 0.0, 1.0, 0.0]),
            treated=np.array([True, True, False, False]),
            participant=np.arange(4),
            scenario=np.array([0, 0, 0, UNKNOWN]),
        )
    )
    assert found.p is None
    assert found.warnings == ("one_scenario",)


def test_who_saw_no_trial_is_not_in_it():
    seen = trials()
    moved = Outcome(seen.name, seen.unit, seen.y, seen.treated, 2 * seen.participant, seen.scenario)
    found = intention_to_treat(moved, trials_dealt=3, missing=0.0)
    assert np.bincount(found.participant).tolist() == [3, 0, 3, 0, 3]


@given(st.integers(1, 3))
def test_nothing_played_is_taken_away(trials_dealt):
    found = intention_to_treat(trials(), trials_dealt, missing=9.0)
    assert np.bincount(found.participant).tolist() == [
        3,
        max(1, trials_dealt),
        max(2, trials_dealt),
    ]
    assert found.y[[0, 1, 2, 3, 5]].tolist() == [1, 0, 1, 1, 1]
    assert found.y[4] == 9
