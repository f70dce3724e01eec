"""Participants as units: their sums, and means that rounding must not set apart."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis import EmptyArmError
from analysis.methods import methods_of
from analysis.statistics.participants import by_participant
from tests.analysis.statistics.outcomes import of_fixture, outcome

NAN = float("nan")


def test_trials_are_summed_up_by_participant_and_those_without_values_counted():
    found = by_participant(
        outcome([1, 2, NAN, 4, NAN, 6], [1, 1, 1, 0, 0, 0], [*"aabccd"], [*"stuvwx"])
    )
    assert found.sums.tolist() == [3, 4, 6]
    assert found.trials.tolist() == [2, 1, 1]
    assert found.means.tolist() == [1.5, 4, 6]
    assert found.treated.tolist() == [True, False, False]
    assert found.n_missing == 1


def test_means_of_the_same_values_in_another_order_are_tied():
    orders = list(permutations([0.1, 0.2, 0.3, 0.7]))
    y = np.array(orders).ravel()
    there = np.repeat(np.arange(len(orders)), 4)
    people = by_participant(outcome(y, there % 2, there, np.arange(len(y)) % 4))
    assert len(set(people.sums / people.trials)) > 1
    assert len(set(people.means)) == 1


@given(st.lists(st.integers(-(10**6), 10**6), min_size=2, max_size=20))
def test_means_that_differ_stay_apart_and_in_order(values):
    there = np.arange(len(values))
    milliseconds = np.array(values) / 1000
    means = by_participant(outcome(milliseconds, there > 0, there, there)).means
    assert means.tolist() == milliseconds.tolist()


def test_an_arm_without_values_is_a_structured_error():
    with pytest.raises(EmptyArmError):
        by_participant(outcome([NAN, 1], [0, 1], [*"ab"], [*"ss"]))


@pytest.mark.parametrize("key", ["mann_whitney_participants", "cluster_permutation"])
def test_methods_on_participants_count_who_is_missing_not_trials(paper_fixture, key):
    data = of_fixture(paper_fixture, "confidence")
    data.y[data.participant == 0] = NAN
    data.y[np.flatnonzero(data.participant == 1)[:3]] = NAN
    found = methods_of("confidence", "two_way_auc", 1)[key].run(data)
    assert (found.of, found.n, found.n_missing) == ("participants", 149, 1)


@pytest.mark.parametrize("seed", range(3))
def test_the_order_of_trials_changes_no_rank_of_participants_mean_times(paper_fixture, seed):
    """Two participants of the synthetic trials have the same times but for rounding."""
    data = of_fixture(paper_fixture, "time")
    order = np.random.default_rng(seed).permutation(len(data.y))
    columns = (data.y, data.treated, data.participant, data.scenario)
    shuffled = outcome(*(column[order] for column in columns))
    run = methods_of("prediction_time_s", "two_way_auc", 1)["mann_whitney_participants"].run
    assert len(set(by_participant(shuffled).means)) == 148
    assert run(shuffled).statistic == run(data).statistic
