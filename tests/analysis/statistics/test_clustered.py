"""Clustered comparisons against frozen numbers of R, libraries and their own symmetries."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis import EmptyArmError
from analysis.statistics.clustered import (
    clustered_auc,
    clustered_difference,
    two_way_auc,
    two_way_difference,
)
from analysis.statistics.influence import placements
from tests.analysis.statistics.cases import closely, defined, holds
from tests.analysis.statistics.outcomes import of_fixture, outcome

TESTS: Any = (clustered_difference, clustered_auc, two_way_difference, two_way_auc)
TWO_WAY = TESTS[2:]
NAN = float("nan")
APART = [9, 2, 7, 4, 5, 11, 0, 3, 6, 10, 8, 1]
"""Scenarios of twelve trials, each another, in an order that shows rounding of sums."""


def test_golden_clustered_difference(golden, paper_fixture):
    """R survey 4.1 svyby and svymean, strata = arm, ids = participant; synthetic trials."""
    test = clustered_difference(of_fixture(paper_fixture, "correct"))
    holds(
        closely(golden("cluster_rd_fixture")),
        {
            "p1": test.mean_treatment,
            "p2": test.mean_reference,
            "rd": test.estimate,
            "se": test.se,
            "t": test.statistic,
            "df": test.df,
            "p": test.p,
            "ci": [test.low, test.high],
            "deff1": test.design_effect_treatment,
            "deff2": test.design_effect_reference,
        },
    )


def test_golden_clustered_auc(golden, paper_fixture):
    """R, naive pairwise kernel; synthetic trials."""
    test = clustered_auc(of_fixture(paper_fixture, "time"))
    holds(
        closely(golden("cluster_auc_time")),
        {
            "auc": test.estimate,
            "rank_biserial": test.rank_biserial,
            "se": test.se,
            "t": test.statistic,
            "df": test.df,
            "p": test.p,
            "ci": [test.low, test.high],
        },
    )


def test_golden_two_way_difference(golden, paper_fixture):
    """R sandwich::vcovCL, HC0 with cadjust; synthetic trials."""
    test = two_way_difference(of_fixture(paper_fixture, "correct"))
    holds(
        closely(golden("twoway_lpm_fixture")),
        {
            "rd": test.estimate,
            "se": test.se,
            "t": test.statistic,
            "df": test.df,
            "p": test.p,
        },
    )


def test_golden_two_way_auc(golden, paper_fixture):
    """A separate numpy implementation of the formula; synthetic trials."""
    test = two_way_auc(of_fixture(paper_fixture, "time"))
    holds(
        closely(golden("twoway_auc_time")),
        {
            "auc": test.estimate,
            "v_participant": test.v_participant,
            "v_scenario": test.v_scenario,
            "v_trial": test.v_trial,
            "se": test.se,
            "t": test.statistic,
            "df": test.df,
            "p": test.p,
            "ci": [test.low, test.high],
        },
    )


def test_two_way_variances_are_those_of_statsmodels_with_two_groups(paper_fixture):
    from statsmodels.regression.linear_model import OLS
    from statsmodels.stats.sandwich_covariance import cov_cluster_2groups

    trials = of_fixture(paper_fixture, "confidence")
    test = defined(two_way_difference(trials))
    fit = OLS(trials.y, np.column_stack([np.ones(test.n), trials.treated])).fit()
    # statsmodels also takes the two coefficients off the degrees of freedom
    factor = (test.n - 2) / (test.n - 1)
    both, participants, scenarios = (
        factor * covariance[1, 1]
        for covariance in cov_cluster_2groups(fit, trials.participant, trials.scenario)
    )
    assert test.estimate == pytest.approx(fit.params[1])
    assert test.v_participant == pytest.approx(participants)
    assert test.v_scenario == pytest.approx(scenarios)
    assert test.v_participant + test.v_scenario - test.v_trial == pytest.approx(both)
    assert test.se**2 == pytest.approx(max(both, participants))


@st.composite
def studies(draw):
    """Ratings of 4 to 9 participants, at least two an arm, of up to five scenarios."""
    sizes = draw(st.lists(st.integers(1, 5), min_size=4, max_size=9))
    participant = np.repeat(np.arange(len(sizes)), sizes)
    n = len(participant)
    return outcome(
        draw(st.lists(st.integers(1, 7), min_size=n, max_size=n)),
        participant < draw(st.integers(2, len(sizes) - 2)),
        participant,
        draw(st.lists(st.integers(0, 4), min_size=n, max_size=n)),
    )


def rows(trials, order):
    """The trials in another order, or some of them, or some repeatedly."""
    return replace(
        trials,
        y=trials.y[order],
        treated=trials.treated[order],
        participant=trials.participant[order],
        scenario=trials.scenario[order],
    )


def same(one, other):
    """Results agree up to rounding."""
    for name in ("estimate", "se", "low", "high", "statistic", "df", "p", "n", "warnings"):
        value = getattr(other, name)
        if isinstance(value, float):
            value = pytest.approx(value, rel=1e-6, abs=1e-9)
        assert getattr(one, name) == value, name


@given(studies())
def test_swapping_the_arms_mirrors_the_estimate_and_keeps_p(trials):
    swapped = replace(trials, treated=~trials.treated)
    for test in TESTS:
        one, other = test(trials), test(swapped)
        if other.statistic is not None:
            low, high = 2 * one.null - other.high, 2 * one.null - other.low
            other = replace(other, low=low, high=high, statistic=-other.statistic)
        other = replace(other, estimate=2 * one.null - other.estimate)
        same(one, other)


@given(studies())
def test_a_monotone_transform_keeps_the_auc(trials):
    for test in TESTS[1::2]:
        assert test(trials) == test(replace(trials, y=np.exp(trials.y) - 40))


@given(studies(), st.integers(2, 3))
def test_copies_of_trials_under_the_same_participant_add_no_certainty(trials, copies):
    copied = rows(trials, np.tile(np.arange(len(trials.y)), copies))
    for test in TESTS:
        one, other = test(trials), test(copied)
        assert one.estimate == pytest.approx(other.estimate)
        if one.se is not None:
            assert other.se > one.se * (1 - 1e-9)
        if test not in TWO_WAY:
            same(replace(other, n=one.n), one)


@given(studies(), st.randoms())
def test_the_order_of_trials_changes_nothing(trials, random):
    order = list(range(len(trials.y)))
    random.shuffle(order)
    for test in TESTS:
        same(test(rows(trials, order)), test(trials))


@given(studies())
def test_the_auc_is_scipys_u_and_placements_are_counted_pairs(trials):
    x, y = trials.y[trials.treated], trials.y[~trials.treated]
    u = stats.mannwhitneyu(x, y).statistic
    assert clustered_auc(trials).estimate == pytest.approx(u / (len(x) * len(y)))
    wins = (x[:, None] > y) + (x[:, None] == y) / 2
    placed = placements(trials)
    assert placed[trials.treated] == pytest.approx(wins.mean(axis=1))
    assert placed[~trials.treated] == pytest.approx(wins.mean(axis=0))


@given(studies())
def test_trials_without_a_value_are_as_if_they_were_not_there_but_counted(trials):
    more = outcome(
        [*trials.y, NAN, NAN],
        [*trials.treated, True, False],
        [*trials.participant, 0, 99],
        [*trials.scenario, 7, 7],
    )
    for test in TESTS:
        assert replace(test(more), n_missing=0) == test(trials)
        assert test(more).n_missing == 2


@pytest.mark.parametrize("test", TESTS)
def test_an_empty_arm_is_a_structured_error(test):
    with pytest.raises(EmptyArmError, match=r"condition reference: .* measure"):
        test(outcome([1, 2, NAN], [1, 1, 0], [*"abc"], [*"sts"]))


@pytest.mark.parametrize("test", TESTS)
def test_one_participant_in_an_arm_leaves_the_estimate_without_certainty(test):
    found = test(outcome([4, 5, 6, 1, 2], [1, 1, 1, 0, 0], [*"aabcc"], [*"ststs"]))
    assert found.estimate > found.null
    assert (found.se, found.low, found.statistic, found.p) == (None,) * 4
    assert found.warnings == ("one_participant",)


@pytest.mark.parametrize("test", TWO_WAY)
def test_one_scenario_leaves_the_estimate_without_certainty(test):
    found = test(outcome([4, 5, 1, 2], [1, 1, 0, 0], [*"abcd"], [*"ssss"]))
    assert (found.se, found.p, found.v_scenario) == (None, None, None)
    assert found.warnings == ("one_scenario",)


@pytest.mark.parametrize("test", TWO_WAY)
def test_two_scenarios_are_tested_on_one_degree_of_freedom_with_a_warning(test):
    found = defined(test(outcome([4, 5, 1, 9], [1, 1, 0, 0], [*"abcd"], [*"stst"])))
    assert (found.df, found.scenarios, found.participants) == (1, 2, 4)
    assert found.p == pytest.approx(2 * stats.t.sf(abs(found.statistic), 1))
    assert found.warnings == ("few_clusters",)


@pytest.mark.parametrize("test", TESTS)
def test_equal_values_are_no_difference_and_say_so(test):
    found = test(outcome([0.1] * 6, [1, 1, 1, 0, 0, 0], [*"aabccd"], [*"ststst"]))
    assert (found.estimate, found.statistic, found.p) == (found.null, None, 1.0)
    assert "constant_outcome" in found.warnings


@pytest.mark.parametrize("test", TESTS)
def test_arms_that_differ_without_variation_are_not_tested(test):
    found = test(outcome([0.7] * 3 + [0.1] * 3, [1, 1, 1, 0, 0, 0], [*"aabccd"], [*"ststst"]))
    assert found.estimate > found.null
    assert (found.statistic, found.p, found.low) == (None, None, None)
    reason = {"probability": "no_overlap"}.get(found.unit, "no_variation")
    assert {"no_overlap", "no_variation"} & set(found.warnings) == {reason}


@pytest.mark.parametrize("test", [clustered_auc, two_way_auc])
@pytest.mark.parametrize("swapped", [False, True])
def test_arms_without_overlap_are_said_to_have_none_whose_participants_differ(test, swapped):
    treated = np.array([1, 1, 1, 0, 0, 0], dtype=bool) ^ swapped
    found = test(outcome([5, 7, 6, 1, 3, 2], treated, [*"aabccd"], [*"ststst"]))
    assert (found.estimate, found.p) == (0.0 if swapped else 1.0, None)
    assert {"no_overlap", "no_variation"} & set(found.warnings) == {"no_overlap"}


@pytest.mark.parametrize("test", TESTS)
def test_rounding_is_not_taken_for_variation_between_participants(test):
    alike = [0.1, 0.7, 0.3, 0.7, 0.3, 0.1], [0.2, 0.4, 0.9, 0.9, 0.2, 0.4]
    trials = outcome([*alike[0], *alike[1]], [1] * 6 + [0] * 6, [*"aaabbbcccddd"], APART)
    assert (test(trials).statistic, test(trials).low) == (None, None)
    assert "no_variation" in test(trials).warnings


@pytest.mark.parametrize("test", TWO_WAY)
def test_fewer_than_ten_scenarios_are_few_however_many_participants(test):
    y = np.random.default_rng(5).normal(size=360)
    participant = np.repeat(np.arange(40), 9)
    for scenarios, warnings in ((9, ("few_clusters",)), (10, ())):
        trials = outcome(y, participant < 20, participant, np.arange(360) % scenarios)
        assert test(trials).warnings == warnings


@pytest.mark.parametrize("test", TWO_WAY)
def test_scenarios_of_one_arm_only_are_warned_of(test):
    trials = [4, 5, 6, 1, 2, 9], [1, 1, 1, 0, 0, 0], [*"aabccd"]
    assert "scenarios_not_shared" in test(outcome(*trials, [*"stuusv"])).warnings
    assert "scenarios_not_shared" not in test(outcome(*trials, [*"stuust"])).warnings
    warnings = test(outcome(*trials, [*"stuvwx"])).warnings
    assert {"scenarios_not_shared", "no_scenario_shared"} & set(warnings) == {"no_scenario_shared"}


def test_the_design_effect_of_trials_that_repeat_is_their_number():
    participant = np.repeat(np.arange(40), 5)
    y = np.random.default_rng(3).normal(size=40)[participant]
    found = clustered_difference(outcome(y, participant < 20, participant, participant))
    assert found.design_effect_treatment == pytest.approx(5 * 20 / 19)
    assert found.design_effect_reference == pytest.approx(5 * 20 / 19)
