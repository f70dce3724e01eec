"""The paper's Figure 1: two goals, A on the way to B; the legible path to B leaves A early."""

import numpy as np
import pytest

from policies import (
    ACTION_SETS,
    Action,
    goal_values,
    legible_rewards,
    movement_beliefs,
    parse_maze,
    plan_legible,
    steps_until_sure,
)


def greedy_path(plan, start: int) -> list[int]:
    """The cells on the way when no action fails and the first of tied actions is taken."""
    cells = [start]
    while cells[-1] != plan.maze.goals[plan.goal] and len(cells) < 100:
        x = cells[-1]
        cells.append(int(plan.maze.successors[x, plan.policy_legible[x].argmax()]))
    return cells


class TestFigure1:
    WORLD = parse_maze(
        """\
+---+---+---+---+---+---+---+
| .   .   .   .   .   .   B |
+   +   +   +   +   +   +   +
| .   .   .   .   .   .   . |
+   +   +   +   +   +   +   +
| .   .   .   .   A   .   . |
+---+---+---+---+---+---+---+
"""
    )
    START = 14

    def test_the_legible_way_to_b_leaves_a_early(self):
        plan = plan_legible(self.WORLD, "B")
        path = greedy_path(plan, self.START)
        assert path[1] == self.START - 7
        assert plan.policy_legible[self.START, Action.UP] == 1
        assert path[-1] == self.WORLD.goals["B"]
        assert self.WORLD.goals["A"] not in path

    def test_an_optimal_way_to_b_may_pass_a(self):
        plan = plan_legible(self.WORLD, "B")
        assert plan.policy_optimal[self.START, Action.RIGHT] == 0.5
        assert plan.certificate.stretch[self.START] == pytest.approx(1)

    def test_the_legible_way_to_a_stays_away_from_b(self):
        assert greedy_path(plan_legible(self.WORLD, "A"), self.START) == [14, 15, 16, 17, 18]

    def test_an_observer_knows_sooner(self):
        plan = plan_legible(self.WORLD, "B")
        legible = greedy_path(plan, self.START)
        past_a = [14, 15, 16, 17, 18, 19, 20, 13, 6]
        assert len(legible) == len(past_a)
        known = [
            steps_until_sure(
                movement_beliefs(self.WORLD, plan.q, np.array(path), ACTION_SETS["udlrn"]), 1
            )
            for path in (legible, past_a)
        ]
        assert known[0] + 3 <= known[1]

    def test_the_posterior_that_pays_is_that_of_the_goal_sought(self):
        q = goal_values(self.WORLD, 0.9, ACTION_SETS["udlrn"])
        r = legible_rewards(q, 0.5)
        a, b = self.WORLD.goals["A"], self.WORLD.goals["B"]
        assert r[1, b].min() > 0.8
        assert r[1, a].max() < 0.2
