"""The preset `authors` on two toy mazes: one by hand, one by plain Python."""

import math

import numpy as np
import pytest

from policies import parse_maze
from policies.experiments import authors
from policies.experiments.comparison import design_comparison
from policies.experiments.scaling import play_pair
from policies.experiments.worlds import Pair, World
from tests.policies.plain import Plain

TWO_CELLS = """\
+---+---+
| A   B |
+---+---+
"""
ROOMS = """\
+---+---+---+---+
| A   .   . | C |
+   +   +---+   +
| .   .   .   . |
+   +---+   +   +
| .   . | B   . |
+---+---+---+---+
"""
KAPPA = 0.85 * 0.9 / (1 - 0.15 * 0.9)
"""What a cell is worth, of the next cell on the way: .8843931."""


def row_of(text, start, goal, framework, **effort):
    """The row of one pair under the preset."""
    comparison = design_comparison("authors", **effort)
    world = World("toy", parse_maze(text))
    (row,) = play_pair(world, Pair(0, start, goal), [framework], comparison)
    return row


def logistic(odds):
    return 1 / (1 + math.exp(-odds))


class TestByHand:
    """From B to A in two cells.

    Staying at a goal is worth 1 / (1 - .9) = 10, so a cell beside it 10 kappa. Each of A's values
    is one of B's in the other cell, and with two goals a posterior is a logistic function.
    """

    AT_GOAL, BESIDE = 10.0, 10 * KAPPA
    LEAVING = 1 + 0.9 * (0.15 * AT_GOAL + 0.85 * BESIDE)
    STAYING_BESIDE = 0.9 * BESIDE

    def test_the_seeds_uniforms_are_those_of_the_walk_below(self):
        drawn = np.random.default_rng(2021).random(5)
        assert drawn.round(3).tolist() == [0.757, 0.941, 0.592, 0.319, 0.626]

    @pytest.mark.parametrize("framework", ["polmdp", "optimal"])
    def test_the_walk_and_its_measures(self, framework):
        # .757: left, the one best action. .941: over the states A (.85) and B (.15), stay at B.
        # .592: left. .319: to A. .626: of up, down and left, which tie there, the second: down.
        for_left = 0.5 * (self.BESIDE - self.LEAVING)
        for_down = 0.5 * (self.AT_GOAL - self.STAYING_BESIDE)
        polmdp = (1 + 0.9) * logistic(for_left) + 0.81 * logistic(for_down)
        beliefs = [logistic(odds) for odds in (for_left, 2 * for_left, 2 * for_left + for_down)]
        lmdp = sum(0.9**t * math.sqrt(1 - b**2) for t, b in enumerate(beliefs))
        row = row_of(TWO_CELLS, 1, "A", framework)
        assert (row["steps"], row["arrived"]) == (2, 1)
        assert row["polmdp"] == pytest.approx(polmdp, abs=1e-12)
        assert row["lmdp"] == pytest.approx(lmdp, abs=1e-12)
        # The same in digits, worked out on paper: .4661 twice, .7350; beliefs .4661, .4325, .6788.
        assert row["polmdp"] == pytest.approx(1.481, abs=1e-3)
        assert row["lmdp"] == pytest.approx(2.291, abs=1e-3)


class TestByPlainPython:
    @pytest.mark.parametrize("goal", "ABC")
    @pytest.mark.parametrize("start", [1, 5, 8, 9, 11])
    def test_walks_and_measures_of_both_policies(self, start, goal):
        plain = Plain(ROOMS, goal)
        for framework, q in (("polmdp", plain.q_legible), ("optimal", plain.q[goal])):
            states, taken = plain.play(q, start)
            row = row_of(ROOMS, start, goal, framework)
            assert (row["steps"], row["arrived"]) == (len(states) - 1, 1)
            assert (row["polmdp"], row["lmdp"]) == pytest.approx(plain.measures(states, taken))

    @pytest.mark.parametrize("start", [1, 9])
    def test_the_baseline_searches_once_more_where_it_ended(self, start):
        plain, rng = Plain(ROOMS, "C"), np.random.default_rng(2021)
        states, taken = [start], list[int]()
        while states[-1] != plain.goals["C"] and len(taken) < 502:
            q, _ = plain.search(states[-1], 10, rng)
            taken.append(q.index(min(q)))
            fails = rng.random() < 0.15
            states.append(states[-1] if fails else plain.after[states[-1]][taken[-1]])
        last = Plain(ROOMS, "C", depth=20)
        q, _ = last.search(states[-1], 1000, rng)
        taken.append(q.index(min(q)))
        row = row_of(ROOMS, start, "C", "lmdp", simulations=10)
        assert row["steps"] == len(states) - 1
        assert (row["polmdp"], row["lmdp"]) == pytest.approx(plain.measures(states, taken))

    def test_that_search_has_1000_samples_of_depth_20(self):
        """No return ends early in a corridor; what is drawn next tells how many draws were."""
        corridor = "+---" * 24 + "+\n| A   B " + "  . " * 22 + "|\n" + "+---" * 24 + "+\n"
        rng, plains = np.random.default_rng(2021), np.random.default_rng(2021)
        taken = authors.search_once_more(parse_maze(corridor), "A", 23, rng)
        q, n = Plain(corridor, "A", depth=20).search(23, 1000, plains)
        assert taken == q.index(min(q))
        assert sum(n) == 8 + 1000
        assert rng.random() == plains.random()


class TestThePolicies:
    def test_values_within_1e_10_tie(self):
        q = np.array([[1.0, 1.0 - 0.9e-10, 1.0 - 1.2e-10, 0.0]])
        assert authors.policy_of(q).tolist() == [[0.5, 0.5, 0, 0]]

    def test_a_walk_that_never_arrives_ends_after_502_moves(self):
        maze = parse_maze(TWO_CELLS)
        up = np.tile([1.0, 0, 0, 0], (2, 1))
        rollout, last = authors.roll_out(maze, up, Pair(0, 1, "A"), np.random.default_rng(2021))
        assert (rollout.steps, rollout.arrived, last) == (502, False, 0)
