"""Sizes at which the two-way tests do not hold their level are told, and no others."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.statistics.clustered import two_way_auc, two_way_difference
from analysis.statistics.few_clusters import few
from tests.analysis.statistics.outcomes import outcome

LEVELS = {
    (4, 4): {12: (0.054, 0.055), 37: (0.056, 0.059), 300: (0.060, 0.058)},
    (6, 6): {12: (0.056, 0.058), 37: (0.055, 0.058), 300: (0.056, 0.059)},
    (12, 12): {12: (0.050, 0.044), 37: (0.058, 0.058), 300: (0.053, 0.055)},
    (20, 20): {12: (0.049, 0.039), 37: (0.055, 0.053), 300: (0.056, 0.056)},
    (75, 75): {12: (0.047, 0.043), 37: (0.049, 0.048), 300: (0.051, 0.053)},
    (4, 12): {
        5: (0.045, 0.042),
        8: (0.061, 0.070),
        12: (0.067, 0.076),
        20: (0.068, 0.075),
        37: (0.072, 0.077),
        300: (0.078, 0.077),
    },
    (8, 32): {12: (0.060, 0.060), 37: (0.064, 0.068), 300: (0.068, 0.072)},
    (12, 36): {12: (0.052, 0.047), 37: (0.057, 0.063), 300: (0.059, 0.064)},
}
"""Share of simulated studies without a difference in which a two-way test has p < .05.

By participants of the arms, then scenarios: with 10 and with 100 trials each, the larger of the
difference of correct guesses and the AUC of confidence, with SDs .8/.5/.8 and .8/0/0. From:

goalguess level --participants N/M --scenarios J --trials K --sds .8/.5/.8,.8/0/0 --tests
two_way_difference,two_way_auc --replicates 20000

75 + 75 with 10,000 replicates, and 4,000 with 100 trials.
"""
CELLS = [(arms, scenarios) for arms, levels in LEVELS.items() for scenarios in levels]


@pytest.mark.parametrize(("arms", "scenarios"), CELLS)
def test_a_size_is_told_where_its_level_is_above_6_percent_or_at_it(arms, scenarios):
    largest = max(LEVELS[arms][scenarios])
    told = "few_and_unequal" in few(arms, scenarios)
    assert told or largest <= 0.06
    assert largest >= 0.06 or not told
    assert few(arms[::-1], scenarios) == few(arms, scenarios)


def test_scenarios_that_nobody_knows_cannot_bind_the_degrees_of_freedom():
    assert few((12, 36), 12) == ()
    assert few((12, 36), 0) == ("few_and_unequal",)
    assert few((12, 12), 0) == ()


@pytest.mark.parametrize("arms", [(75, 75), (60, 90), (98, 52), (20, 400)])
def test_of_twenty_participants_an_arm_and_ordinary_scenarios_nothing_is_told(arms):
    assert few(arms, 37) == ()


@pytest.mark.parametrize("participants", [(9, 9), (9,), (9, 10)])
def test_few_that_are_as_many_in_each_arm_are_told_as_few(participants):
    assert few(participants, 37) == ("few_clusters",)
    assert few([n + 1 for n in participants], 37) == ()
    assert few([n + 1 for n in participants], 9) == ("few_clusters",)


@given(st.integers(2, 60), st.integers(2, 60), st.integers(2, 400))
def test_more_participants_of_the_smaller_arm_never_bring_the_warning(n, m, scenarios):
    smaller, larger = sorted((n, m))
    if "few_and_unequal" not in few((smaller, larger), scenarios):
        nearer = (min(smaller + 1, larger), larger)
        assert "few_and_unequal" not in few(nearer, scenarios)


@pytest.mark.parametrize("test", [two_way_difference, two_way_auc])
def test_the_two_way_tests_carry_the_warning_that_says_more_and_not_both(test):
    participant = np.repeat(np.arange(16), 10)
    y = np.random.default_rng(1).normal(size=160)
    trials = outcome(y, participant < 4, participant, np.arange(160) % 37)
    assert test(trials).warnings == ("few_and_unequal",)
