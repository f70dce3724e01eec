"""Dealing: bounds of the instrument, over seeds and over every number of places dealt."""

from collections import Counter
from itertools import chain, islice
from zlib import crc32

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.assignment import Place, balanced_lists, deal_block, lists_in_cycle
from app.errors import DealingFailed
from policies import Scenario, load_pool
from tests.app.dealing_bounds import arm_difference, scenario_lead, unbalanced

SCENARIOS = load_pool().scenarios


def places(seed: int, count: int, size: int = 4, stream: str = "participant") -> list[Place]:
    blocks = (deal_block(seed, stream, block, size, SCENARIOS) for block in range(count))
    return list(islice(chain.from_iterable(blocks), count))


@given(st.integers(0, 2**32 - 1), st.sampled_from([2, 4, 6, 10]))
@settings(max_examples=20, deadline=None)
def test_conditions_never_differ_by_more_than_half_a_block(seed, size):
    assert arm_difference(places(seed, 60, size)) <= size / 2


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=5, deadline=None)
def test_within_a_condition_no_scenario_is_ahead_of_another_by_more_than_one(seed):
    assert scenario_lead(places(seed, 200), SCENARIOS) <= 1


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=5, deadline=None)
def test_each_list_has_ten_scenarios_each_goal_1_to_3_times_and_each_maze_1_to_4_times(seed):
    assert unbalanced(places(seed, 160), SCENARIOS) == []


def test_the_same_seed_deals_the_same_places():
    assert places(7, 40) == places(7, 40)


def test_another_seed_or_stream_deals_other_places():
    assert places(7, 8) != places(8, 8)
    assert places(7, 8) != places(7, 8, stream="simulated")


def test_a_study_under_way_is_dealt_on_from_the_same_lists_by_every_version():
    # Drawn otherwise, by us or by another numpy, they would not go on from those dealt before.
    lists = balanced_lists(SCENARIOS, (2209, 1))
    assert lists[0] == ("s27", "s13", "s11", "s26", "s19", "s16", "s33", "s37", "s10", "s07")
    assert crc32(repr(lists).encode()) == 3106749342


def test_places_are_numbered_through_the_blocks():
    assert [place.number for place in places(1, 12)] == list(range(12))


def test_a_cycle_of_lists_uses_every_scenario_equally_often():
    lists = balanced_lists(SCENARIOS, (1, 2))
    assert len(lists) == lists_in_cycle(SCENARIOS) == 37
    assert set(Counter(chain.from_iterable(lists)).values()) == {10}


def test_the_order_within_lists_is_random():
    firsts = {scenarios[0] for scenarios in balanced_lists(SCENARIOS, (3,))}
    assert len(firsts) > 15


def test_a_pool_that_allows_no_balanced_list_is_refused():
    one_goal = tuple(Scenario(f"s{i}", "maze", i, "A") for i in range(12))
    with pytest.raises(DealingFailed, match="12 scenarios given allow none"):
        balanced_lists(one_goal, (1,))
