"""What measures the dealing notices what is wrong with it."""

from dataclasses import replace

import pytest

from app.assignment import Place, deal_block
from policies import load_pool
from tests.app.dealing_bounds import Dealings, arm_difference, scenario_lead, unbalanced

SCENARIOS = load_pool().scenarios
IDS = [scenario.id for scenario in SCENARIOS]


def dealt(*conditions: str) -> list[Place]:
    """Places of these conditions, all with the same list."""
    return [Place(i, condition, tuple(IDS[:10])) for i, condition in enumerate(conditions)]


@pytest.mark.parametrize(
    ("conditions", "difference"),
    [([], 0), (["optimal"], 1), (["polmdp", "polmdp", "optimal", "optimal", "optimal"], 2)],
)
def test_the_difference_between_conditions_is_the_largest_on_the_way(conditions, difference):
    assert arm_difference(dealt(*conditions)) == difference


def test_a_scenario_is_ahead_of_another_only_within_a_condition():
    assert scenario_lead(dealt("polmdp", "optimal"), SCENARIOS) == 1
    assert scenario_lead(dealt("polmdp", "optimal", "polmdp"), SCENARIOS) == 2


def test_a_list_without_its_balance_is_named():
    first, second = list(deal_block(1, "participant", 0, 2, SCENARIOS))
    goal_a = [scenario.id for scenario in SCENARIOS if scenario.goal == "A"]
    one_maze = [scenario.id for scenario in SCENARIOS if scenario.maze == SCENARIOS[0].maze]
    for wrong in (second.scenarios[:9], second.scenarios[:9] * 2, [*goal_a, *one_maze][:10]):
        assert unbalanced([first, replace(second, scenarios=tuple(wrong))], SCENARIOS) == [1]


def test_dealings_again_and_out_of_order_are_counted():
    in_order = Dealings([0, 1, 0, 2, 1], dealt(*["polmdp"] * 3))
    assert (in_order.again, in_order.out_of_order) == (2, 0)
    assert Dealings([0, 2, 1], dealt(*["polmdp"] * 3)).out_of_order == 2
