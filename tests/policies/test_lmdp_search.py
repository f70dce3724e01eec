"""The tree search against brute force over (state, belief)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from policies import (
    ACTION_SETS,
    FAILURE,
    Search,
    action_beliefs,
    belief_distance,
    goal_values,
    random_maze,
)
from policies.lmdp import TreeSearch
from policies.lmdp_kernels import NONE, Costs, stage_cost
from policies.observer import updated

ACTIONS = ACTION_SETS["udlr"]


class Brute:
    """Expected costs of the next `depth` stages, by enumerating every history."""

    def __init__(self, maze, search: Search) -> None:
        self.maze, self.search, self.goal = maze, search, maze.goals["A"]
        q = np.exp(search.beta * goal_values(maze, search.gamma, ACTIONS))
        self.pi = q / q.sum(axis=2, keepdims=True)

    def costs(self, x, belief, depth):
        """Of each action now and the best ones after it."""
        return np.array([self._after(x, belief, a, depth) for a in range(4)])

    def _after(self, x, belief, a, depth):
        seen = updated(belief, self.pi[:, x, a])
        y = self.maze.successors[x, a]
        return FAILURE * self._at(x, seen, depth) + (1 - FAILURE) * self._at(y, seen, depth)

    def _at(self, x, belief, depth):
        if x == self.goal:
            return 0.0
        far = belief_distance(belief, 0, self.search.distance)
        if depth > 1:
            far += self.costs(x, belief, depth - 1).min()
        return far + self.search.task


def searched(seed: int, search: Search):
    """A tiny maze, a state and belief in it, and the search run from there."""
    rng = np.random.default_rng(seed)
    maze = random_maze(2, 3, 2, rng, openness=0.5)
    start = int(rng.choice(np.delete(np.arange(6), list(maze.goals.values()))))
    belief = rng.dirichlet(np.ones(2))
    searching = TreeSearch(maze, "A", search)
    assert searching.run(start, belief, rng) == search.simulations
    return maze, start, belief, searching.tree


class TestAgainstBruteForce:
    @pytest.mark.parametrize("seed", range(4))
    @pytest.mark.parametrize("distance", ["tv", "euclid", "kl"])
    @pytest.mark.parametrize("rollouts", ["optimal", "random"])
    def test_is_expectimax_as_simulations_grow(self, seed, distance, rollouts):
        search = Search(distance, simulations=300_000, depth=4, rollouts=rollouts, actions="udlr")
        maze, start, belief, tree = searched(seed, search)
        exact = Brute(maze, search).costs(start, belief, 4)
        best = tree.q[0].argmin()
        # Actions nearly as good may change places; what exploring costs falls with ln(n) / n.
        assert exact[best] == pytest.approx(exact.min(), abs=1e-3)
        assert tree.q[0, best] == pytest.approx(exact.min(), abs=0.02)
        spread = 4 * (1.1 if distance != "kl" else 3)
        assert (tree.q[0] > exact - 5 * spread / np.sqrt(tree.visits[0])).all()

    def test_more_simulations_come_nearer(self):
        def error(simulations: int) -> float:
            search = Search(simulations=simulations, depth=4, actions="udlr")
            off = []
            for seed in range(12):
                maze, start, belief, tree = searched(seed, search)
                exact = Brute(maze, search).costs(start, belief, 4)
                off.append(abs(tree.q[0].min() - exact.min()))
            return float(np.mean(off))

        assert error(50_000) < error(500) / 3


class TestTheTree:
    @settings(max_examples=15, deadline=None)
    @given(st.integers(0, 10**6))
    def test_believes_what_the_observer_believes_of_every_history(self, seed):
        search = Search(simulations=300, depth=8, actions="udlr")
        maze, start, belief, tree = searched(seed, search)
        q = goal_values(maze, search.gamma, ACTIONS)
        histories = {0: ([start], list[int]())}
        for i in range(tree.size[0]):
            states, taken = histories[i]
            seen = action_beliefs(maze, q, np.array(states), np.array(taken), ACTIONS, prior=belief)
            assert tree.belief[i] == pytest.approx(seen[-1], abs=1e-12)
            for a, moved in zip(*np.nonzero(tree.child[i] != NONE), strict=True):
                y = maze.successors[states[-1], a] if moved else states[-1]
                histories[tree.child[i, a, moved]] = ([*states, int(y)], [*taken, int(a)])
        assert len(histories) == tree.size[0]

    def test_every_simulation_passes_the_root_and_adds_at_most_a_node(self):
        _, _, _, tree = searched(1, Search(simulations=500, depth=6, actions="udlr"))
        assert tree.visits[0].sum() == 500
        assert (tree.visits[0] > 0).all()
        assert tree.size[0] <= 501

    def test_values_an_action_from_its_first_visit_by_what_came_of_it(self):
        for seed in range(6):
            _, _, _, tree = searched(seed, Search(simulations=4, depth=1, actions="udlr"))
            for a in range(4):
                (came,) = tree.child[0, a][tree.child[0, a] != NONE]
                assert (tree.visits[0, a], tree.q[0, a]) == (1, tree.cost[came])

    def test_no_history_is_longer_than_the_depth(self):
        _, start, _, tree = searched(2, Search(simulations=2000, depth=2, actions="udlr"))
        level = {0: 0}
        for i in range(tree.size[0]):
            for j in tree.child[i][tree.child[i] != NONE] if i in level else ():
                level[int(j)] = level[i] + 1
        assert max(level.values()) == 2
        assert tree.state[0] == start


class TestStageCosts:
    @pytest.mark.parametrize("kind", ["tv", "euclid", "kl"])
    def test_are_the_observers_distances_plus_the_task(self, kind):
        rng = np.random.default_rng(0)
        searching = TreeSearch(random_maze(2, 3, 3, rng), "B", Search(distance=kind))
        away = searching.world.goal_state - 1
        for belief in rng.dirichlet(np.ones(3), 20):
            cost = stage_cost(searching.world, searching.costs, away, belief)
            assert cost == pytest.approx(belief_distance(belief, 1, kind) + 0.1)

    def test_are_none_at_the_goal(self):
        searching = TreeSearch(random_maze(2, 3, 3, np.random.default_rng(0)), "B", Search())
        goal = searching.world.goal_state
        assert stage_cost(searching.world, searching.costs, goal, np.ones(3) / 3) == 0

    @pytest.mark.parametrize("kind", range(3))
    def test_stay_finite_and_are_never_below_zero_at_the_ends(self, kind):
        searching = TreeSearch(random_maze(2, 3, 3, np.random.default_rng(0)), "B", Search())
        away = searching.world.goal_state - 1
        for goal_belief in (0.0, 1.0, 1 + 2**-52):
            belief = np.array([1 - goal_belief, goal_belief, 0.0])
            cost = stage_cost(searching.world, Costs(kind, 0.0), away, belief)
            assert -1e-15 <= cost < 800
