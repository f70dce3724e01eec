"""One rule for the degrees of freedom of every clustered t: closed forms and golden cases."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis.statistics.chance import against_chance
from analysis.statistics.clustered import (
    clustered_auc,
    clustered_difference,
    two_way_auc,
    two_way_difference,
)
from analysis.statistics.mixed_model import crossed_logistic
from analysis.statistics.ordinal_mixed import crossed_ordinal
from analysis.statistics.outcome import UNKNOWN
from tests.analysis.statistics.cases import closely, defined, holds
from tests.analysis.statistics.outcomes import of_fixture, outcome


def between(sizes, trials=1, scenarios=None, seed=0):
    """Values of other participants in each arm, who differ; a scenario a trial unless told."""
    rng = np.random.default_rng(seed)
    n = sum(sizes) * trials
    participant = np.repeat(np.arange(sum(sizes)), trials)
    y = rng.normal(size=sum(sizes))[participant] + rng.normal(size=n)
    scenario = np.arange(n) % (scenarios or n)
    return outcome(y, participant < sizes[0], participant, scenario)


def within(participants, scenarios=None, seed=0):
    """A trial of everybody in each arm; a scenario a trial unless told."""
    rng = np.random.default_rng(seed)
    ability = rng.normal(size=participants)
    y = np.concatenate([ability + rng.normal(size=participants) + more for more in (0.3, 0)])
    people = np.tile(np.arange(participants), 2)
    scenario = np.arange(2 * participants) % (scenarios or 2 * participants)
    return outcome(y, np.arange(2 * participants) < participants, people, scenario)


def without_scenarios(trials):
    return replace(trials, scenario=np.full_like(trials.scenario, UNKNOWN))


@pytest.mark.parametrize("forget", [False, True])
def test_golden_welch_where_scenarios_do_not_bind(golden, paper_fixture, forget):
    """R survey 4.1 svyby and svymean, Satterthwaite; synthetic trials, each of its own scenario."""
    trials = of_fixture(paper_fixture, "correct")
    trials = replace(trials, scenario=np.arange(len(trials.y)))
    found = two_way_difference(without_scenarios(trials) if forget else trials)
    holds(closely(golden("cluster_rd_fixture")), {"df": found.df})


@pytest.mark.parametrize("sizes", [(4, 4), (4, 12), (30, 5)])
def test_a_trial_of_each_participant_has_the_degrees_of_scipys_welch_test(sizes):
    trials = between(sizes)
    welch = stats.ttest_ind(trials.y[trials.treated], trials.y[~trials.treated], equal_var=False)
    assert two_way_difference(trials).df == pytest.approx(welch.df)
    one_way = clustered_difference(trials)
    assert (one_way.statistic, one_way.df, one_way.p) == pytest.approx(
        (welch.statistic, welch.df, welch.pvalue)
    )


@pytest.mark.parametrize("test", [two_way_difference, clustered_difference])
@pytest.mark.parametrize("forget", [False, True])
def test_a_trial_of_everybody_in_each_arm_is_scipys_paired_t_test(test, forget):
    trials = within(7)
    found = defined(test(without_scenarios(trials) if forget else trials))
    paired = stats.ttest_rel(trials.y[trials.treated], trials.y[~trials.treated])
    assert (found.statistic, found.df, found.p) == pytest.approx(
        (paired.statistic, 6, paired.pvalue)
    )
    interval = paired.confidence_interval()
    assert (found.low, found.high) == pytest.approx((interval.low, interval.high))


@pytest.mark.parametrize("test", [two_way_auc, clustered_auc])
def test_the_auc_of_right_and_wrong_within_participants_is_scipys_paired_t_test_too(test):
    """Of values 0 and 1 the AUC is half their difference above .5."""
    trials = within(9)
    trials = replace(trials, y=(trials.y > 0.2).astype(float))
    found = defined(test(trials))
    paired = stats.ttest_rel(trials.y[trials.treated], trials.y[~trials.treated])
    assert 2 * found.estimate - 1 == pytest.approx(
        trials.y[trials.treated].mean() - trials.y[~trials.treated].mean()
    )
    assert (found.statistic, found.df, found.p) == pytest.approx(
        (paired.statistic, 8, paired.pvalue)
    )


@pytest.mark.parametrize("test", [two_way_difference, two_way_auc])
@pytest.mark.parametrize(("participants", "scenarios", "df"), [(20, 5, 4), (6, 11, 5)])
def test_within_participants_the_smaller_of_participants_and_scenarios_counts(
    test, participants, scenarios, df
):
    assert test(within(participants, scenarios)).df == df


def test_somebody_in_both_arms_leaves_the_participants_of_the_smaller_arm():
    trials = between((4, 30))
    crossed = replace(trials, participant=np.where(trials.participant == 33, 0, trials.participant))
    assert two_way_difference(crossed).df == 3


@pytest.mark.parametrize(("participants", "scenarios", "df"), [(20, 5, 4), (6, 11, 5)])
def test_one_arm_has_the_smaller_of_participants_and_scenarios(participants, scenarios, df):
    trials = between((participants, 40), trials=6, scenarios=scenarios)
    trials = replace(trials, y=(trials.y > 0).astype(float))
    assert against_chance(trials, 1 / 6)[0].df == df


def test_scenarios_bind_between_subjects_where_they_are_fewer():
    assert two_way_difference(between((20, 20), trials=6, scenarios=9)).df == 8


@given(st.tuples(st.integers(2, 12), st.integers(2, 12)), st.integers(1, 4), st.integers(0, 10**6))
def test_the_degrees_lie_between_those_of_the_smaller_arm_and_of_both(sizes, trials, seed):
    df = clustered_difference(between(sizes, trials, seed=seed)).df
    assert min(sizes) - 1 - 1e-9 <= df <= sum(sizes) - 2 + 1e-9


def test_arms_whose_participants_do_not_differ_have_those_of_the_smaller_arm():
    """Their scenarios do, in opposite ways in the arms; Welch's would be 0 by 0."""
    y = [1, 2, 3] * 2 + [3, 2, 1] * 3
    found: Any = two_way_difference(
        outcome(y, [1] * 6 + [0] * 9, np.repeat(np.arange(5), 3), [*"abc" * 5])
    )
    assert found.v_participant == 0
    assert (found.df, found.p) == (1, pytest.approx(1))


@pytest.mark.parametrize("test", [two_way_difference, two_way_auc])
def test_without_scenarios_participants_alone_are_clusters_which_is_told(test):
    found = defined(test(without_scenarios(between((15, 12), trials=4))))
    assert found.se == pytest.approx(found.v_participant**0.5)
    assert (found.v_scenario, found.v_trial, found.scenarios) == (None, None, 0)
    assert found.warnings == ("no_scenario_known",)


def test_the_mixed_models_have_the_degrees_of_the_two_way_tests():
    trials = between((7, 16), trials=8, scenarios=30)
    correct = replace(trials, y=(trials.y > 0).astype(float))
    rated = replace(trials, y=np.digitize(trials.y, [-1.0, 0.0, 1.0]).astype(float))
    logistic, ordinal = crossed_logistic(correct), crossed_ordinal(rated)
    assert logistic.df == pytest.approx(two_way_difference(correct).df)
    assert ordinal.df == pytest.approx(two_way_auc(rated).df)
    for found in map(defined, (logistic, ordinal)):
        assert 6 <= found.df < 21
        assert found.p == pytest.approx(2 * stats.t.sf(abs(found.statistic), found.df))
