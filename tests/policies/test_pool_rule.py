from collections import Counter

import numpy as np
import pytest

from policies import StimulusError, parse_maze
from policies.pool_build import package_mazes
from policies.pool_rule import (
    Candidate,
    Planner,
    can_balance,
    candidates,
    choose,
    fault,
    generator,
    practice_fault,
)

GOAL = 50


def path(steps: int, by: int = 1) -> list[int]:
    """Cells of a rollout that takes `steps` steps and enters the goal with the last."""
    return [by + x for x in range(steps)] + [GOAL]


class TestPair:
    def test_two_ways_to_the_goal_keep_the_rule(self):
        assert fault([path(14), path(17, by=2)], GOAL) is None
        assert fault([path(26), path(23, by=2)], GOAL) is None

    def test_both_arrive(self):
        assert "end on entering" in str(fault([path(14)[:-1], path(14, by=2)], GOAL))
        assert "end on entering" in str(fault([path(14), [*path(14, by=2), 3]], GOAL))
        assert "end on entering" in str(fault([path(14), [*path(14, by=2), GOAL]], GOAL))

    @pytest.mark.parametrize(("one", "other"), [(13, 14), (14, 13), (27, 26), (26, 27)])
    def test_both_take_14_to_26_steps(self, one, other):
        said = fault([path(one), path(other, by=2)], GOAL)
        assert said == f"expected 14 to 26 steps, came {[one, other]}"

    def test_steps_differ_by_at_most_3(self):
        assert "differ by at most 3, came [14, 18]" in str(fault([path(14), path(18, 2)], GOAL))

    def test_the_cells_visited_differ(self):
        stands = [1, *path(14)]
        assert "differ in the cells" in str(fault([path(14), stands], GOAL))


class TestPractice:
    @pytest.mark.parametrize("steps", [8, 12])
    def test_takes_8_to_12_steps(self, steps):
        assert practice_fault(path(steps), GOAL) is None

    @pytest.mark.parametrize("steps", [7, 13])
    def test_not_fewer_nor_more(self, steps):
        assert f"8 to 12 steps, came {steps}" in str(practice_fault(path(steps), GOAL))

    def test_arrives(self):
        assert "end on entering" in str(practice_fault(path(9)[:-1], GOAL))


class TestCandidates:
    def test_are_all_goals_from_all_cells_that_are_none(self):
        maze = parse_maze("+---+---+---+\n| A   .   B |\n+---+---+---+\n")
        assert candidates(maze, "row") == [Candidate("row", 1, "A"), Candidate("row", 1, "B")]


class TestDraws:
    MAZE = parse_maze("+---+---+---+---+---+\n| A   .   .   .   B |\n+---+---+---+---+---+\n")
    ONE = Candidate("row", 2, "A")

    def test_a_key_of_its_own_gives_numbers_of_its_own(self):
        assert generator(1, "a").random() == generator(1, "a").random()
        keys = [(1, "a"), (2, "a"), (1, "b"), (1, "a", "c")]
        assert len({generator(*key).random() for key in keys}) == 4

    def test_depend_on_seed_scenario_and_condition_only(self):
        one, other = Planner({"row": self.MAZE}, 5), Planner({"row": self.MAZE}, 5)
        other.draw(Candidate("row", 3, "B"), "optimal")
        assert one.draw(self.ONE, "optimal") == other.draw(self.ONE, "optimal")
        many = [tuple(Planner({"row": self.MAZE}, s).draw(self.ONE, "optimal")) for s in range(30)]
        assert len(set(many)) > 1

    def test_practice_is_played_from_both_policies_in_equal_parts(self):
        planner = Planner(package_mazes(), 5)
        legible = planner.policy("practice", "A", "polmdp")
        optimal = planner.policy("practice", "A", "optimal")
        assert not np.array_equal(legible, optimal)
        mixed = planner.policy("practice", "A", "practice")
        assert np.array_equal(mixed, (legible + optimal) / 2)

    def test_legible_stimuli_are_guarded(self):
        assert Planner({"row": self.MAZE}, 5).plan("row", "A").parameters.guard


TWO = {
    name: parse_maze("+---+---+---+---+\n| A   .   B   C |\n+---+---+---+---+\n")
    for name in ("one", "two")
}
MANY = [Candidate(m, x, g) for m in ("one", "two") for g in "ABC" for x in range(40)]


class TestChoice:
    def test_takes_37_with_mazes_and_goals_in_equal_use(self):
        chosen = choose(MANY, TWO, seed=1)
        assert len(set(chosen)) == 37
        assert set(Counter(c.maze for c in chosen).values()) <= {18, 19}
        assert set(Counter(c.goal for c in chosen).values()) <= {12, 13}

    def test_depends_on_the_seed(self):
        first = choose(MANY, TWO, seed=1)
        assert choose(MANY, TWO, seed=1) == first
        assert choose(MANY, TWO, seed=2) != first

    def test_takes_the_rare_where_it_is_needed_for_balance(self):
        common = [c for c in MANY if c.goal != "C"]
        rare = [c for c in MANY if c.goal == "C" and c.start < 9]
        chosen = choose([*common, *rare], TWO, seed=1)
        assert sum(c.goal == "C" for c in chosen) >= 12

    def test_says_when_the_mazes_do_not_give_enough(self):
        with pytest.raises(StimulusError, match="mazes need another design"):
            choose(MANY[:50], TWO, seed=1)

    @pytest.mark.parametrize(
        ("used", "left", "can"),
        [
            ("", 6, True),
            ("aab", 3, True),
            ("aaa", 3, True),
            ("aaaa", 2, False),
            ("aaabbb", 0, False),
            ("aabbcc", 0, True),
            ("aaabbc", 0, True),
        ],
    )
    def test_balance_is_within_one_of_equal_use_and_can_still_be_had(self, used, left, can):
        assert can_balance(list(used), list("abc"), left) == can
