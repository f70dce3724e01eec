from collections.abc import Sequence
from itertools import product
from typing import get_args

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog
from scipy.sparse import coo_array
from scipy.sparse.csgraph import bellman_ford

from policies import (
    ACTION_SETS,
    FAILURE,
    MDP,
    Action,
    Maze,
    ModelError,
    Parameters,
    goal_values,
    legible_rewards,
    maze_rewards,
    maze_transitions,
    parse_maze,
    plan_legible,
    random_maze,
    solve,
    solve_maze,
)
from policies.maze_solver import Variant, least_cost

ACTIONS = ACTION_SETS["udlrn"]
VARIANTS: tuple[Variant, ...] = get_args(Variant)
ROOM = parse_maze("+---+---+\n| A   . |\n+   +   +\n| .   . |\n+---+---+\n")

seeds = st.integers(0, 10**6)
action_sets = st.sampled_from(["udlr", "udlrn"])
betas = st.floats(-3, 6).map(lambda exponent: 10**exponent)
gammas = st.sampled_from([0.0, 0.3, 0.9, 0.99, 0.999, 0.9999])


def in_longer_arithmetic(
    maze: Maze, r: np.ndarray, gamma: float, actions: Sequence[Action], v: np.ndarray
) -> np.ndarray:
    """The optimal values by policy iteration from v in more than double precision.

    A policy is evaluated by doubling: after k rounds 2^k steps of it are summed.
    """
    r, v = r.astype(np.longdouble), v.astype(np.longdouble)
    scale = 1 / (1 - np.longdouble(FAILURE) * np.longdouble(gamma))
    kappa = 1 - scale * (1 - np.longdouble(gamma))
    after, x = maze.successors[:, list(actions)], np.arange(maze.states)
    for _ in range(50):
        q = np.where(
            after == x[:, None], r / (1 - np.longdouble(gamma)), scale * r + kappa * v[after]
        )
        best = q.argmax(axis=1)
        if (q[x, best] - v).max() <= 1e-18 * np.abs(v).max():
            return v
        v, weight, to = scale * r[x, best], np.full(maze.states, kappa), after[x, best]
        for _ in range(24):
            v, weight, to = v + weight * v[to], weight * weight[to], to[to]
    raise AssertionError("policy iteration does not end")


class TestValues:
    @settings(max_examples=60, deadline=None)
    @given(
        seeds,
        action_sets,
        st.sampled_from([0.0, 0.3, 0.9, 0.99]),
        st.sampled_from([0.0, 0.2, 1.0]),
        st.sampled_from([0.0, -1.0]),
    )
    def test_agree_with_the_general_solver_whatever_the_rewards(
        self, seed, names, gamma, openness, shift
    ):
        rng = np.random.default_rng(seed)
        actions = ACTION_SETS[names]
        maze = random_maze(6, 5, 1, rng, openness)
        r = rng.random((30, len(actions))) + shift
        general = solve(MDP(maze_transitions(maze, actions), r, gamma))
        solution = solve_maze(maze, r, gamma, actions)
        assert solution.v == pytest.approx(general.v, abs=1e-9)
        assert solution.q == pytest.approx(general.q, abs=1e-9)
        assert solution.bound <= 1e-8

    @pytest.mark.parametrize("gamma", [0.9, 0.99])
    @pytest.mark.parametrize("names", ["udlr", "udlrn"])
    def test_agree_with_linear_programming(self, draw_maze, names, gamma):
        maze, actions = draw_maze(4, 4, 3, seed=2), ACTION_SETS[names]
        r = maze_rewards(maze, gamma, actions, 0.5, "as_printed")[1][1]
        P = maze_transitions(maze, actions).toarray()
        program = linprog(
            np.ones(16),
            A_ub=gamma * P - np.tile(np.eye(16), (len(actions), 1)),
            b_ub=-r.T.ravel(),
            bounds=(None, None),
            method="highs",
        )
        assert solve_maze(maze, r, gamma, actions).v == pytest.approx(program.x, abs=1e-7)

    @pytest.mark.parametrize("gamma", [0.0, 0.5, 0.9, 0.9999])
    def test_a_long_cycle_that_pays_is_found(self, gamma):
        r = np.zeros((4, 4))
        clockwise = [Action.RIGHT, Action.DOWN, Action.UP, Action.LEFT]
        r[range(4), clockwise] = 1
        solution = solve_maze(ROOM, r, gamma, ACTION_SETS["udlr"])
        # Where the robot is, all that matters is that every try is paid.
        assert solution.v == pytest.approx(np.full(4, 1 / (1 - gamma)), rel=1e-12)
        assert solution.bound <= 1e-8
        assert solution.q.argmax(axis=1).tolist() == clockwise

    @settings(max_examples=40, deadline=None)
    @given(seeds, action_sets, betas, gammas, st.sampled_from(VARIANTS))
    def test_the_error_is_within_the_bound_and_the_bound_within_1e_8(
        self, seed, names, beta, gamma, variant
    ):
        maze, actions = random_maze(9, 8, 4, np.random.default_rng(seed)), ACTION_SETS[names]
        r = maze_rewards(maze, gamma, actions, beta, variant)[1][0]
        solution = solve_maze(maze, r, gamma, actions)
        exact = in_longer_arithmetic(maze, r, gamma, actions, solution.v)
        error = np.abs(exact - solution.v).max()
        assert error <= solution.bound + 4 * np.finfo(float).eps * exact.max()
        assert solution.bound <= 1e-8

    @pytest.mark.parametrize(
        ("r", "gamma", "said"),
        [
            (np.zeros((4, 4)), 0.9, r"finite rewards of shape \(4, 5\), came \(4, 4\)"),
            (np.full((4, 5), np.nan), 0.9, "finite rewards"),
            (np.zeros((4, 5)), 1.0, r"gamma in \[0, 1\), came 1"),
        ],
    )
    def test_bad_input_is_refused(self, r, gamma, said):
        with pytest.raises(ModelError, match=said):
            solve_maze(ROOM, r, gamma, ACTIONS)

    @pytest.mark.parametrize("gamma", [0.9, 0.99, 0.9999])
    def test_a_large_maze_is_solved_within_the_bound(self, draw_maze, gamma):
        maze = draw_maze(150, 150, 3, seed=1)
        r = maze_rewards(maze, gamma, ACTIONS, 0.5, "as_printed")[1][0]
        solution = solve_maze(maze, r, gamma, ACTIONS)
        exact = in_longer_arithmetic(maze, r, gamma, ACTIONS, solution.v)
        error = np.abs(exact - solution.v).max()
        assert error <= solution.bound + 4 * np.finfo(float).eps * exact.max()
        assert solution.bound <= 1e-8


class TestRewards:
    @settings(max_examples=60, deadline=None)
    @given(seeds, action_sets, betas, gammas, st.sampled_from(VARIANTS), st.integers(1, 5))
    def test_are_those_of_the_q_values_for_any_beta_and_gamma(
        self, seed, names, beta, gamma, variant, N
    ):
        maze, actions = random_maze(7, 6, N, np.random.default_rng(seed)), ACTION_SETS[names]
        q, r = maze_rewards(maze, gamma, actions, beta, variant)
        assert np.array_equal(q, goal_values(maze, gamma, actions))
        assert np.isfinite(r).all()
        assert r.sum(axis=0) == pytest.approx(np.ones(r.shape[1:]))
        # beta Q is known to a relative 1e-16: the exponent's rounding is all that may differ.
        rounding = 1e-15 * beta / (1 - gamma) * 10
        assert r == pytest.approx(
            legible_rewards(q, beta, variant), rel=1e-12 + rounding, abs=1e-300
        )

    def test_of_an_unbounded_field_without_no_op_are_those_of_the_q_values(self):
        field = parse_maze(
            "+---+---+---+\n| .   .   . |\n+   +   +   +\n| .   A   . |\n+   +   +   +\n"
            "| .   .   B |\n+---+---+---+\n"
        )
        for beta, variant in product((0.5, 1e5), VARIANTS):
            q, r = maze_rewards(field, 0.99, ACTION_SETS["udlr"], beta, variant)
            assert r == pytest.approx(legible_rewards(q, beta, variant), rel=1e-8, abs=1e-300)

    def test_far_from_all_goals_they_neither_overflow_nor_vanish(self):
        cells = "   ".join(["A", "B", *["."] * 2998])
        corridor = parse_maze(f"+{'---+' * 3000}\n| {cells} |\n+{'---+' * 3000}\n")
        for beta, variant in product((0.5, 59.0, 61.0, 1e6), VARIANTS):
            r = maze_rewards(corridor, 0.9, ACTIONS, beta, variant)[1]
            assert np.isfinite(r).all()
            assert r.sum(axis=0) == pytest.approx(np.ones((3000, 5)))
            assert r[:, -1] == pytest.approx(np.full((2, 5), 0.5))


class TestLeastCost:
    @settings(max_examples=30, deadline=None)
    @given(seeds, action_sets)
    def test_agrees_with_bellman_and_ford(self, seed, names):
        rng = np.random.default_rng(seed)
        actions = ACTION_SETS[names]
        maze = random_maze(6, 7, 1, rng, 0.5)
        cost = rng.random((42, len(actions)))
        x, a = np.nonzero(maze.successors[:, list(actions)] != np.arange(42)[:, None])
        edges = (cost[x, a] / (1 - FAILURE), (maze.successors[x, a], x))
        wanted = bellman_ford(coo_array(edges, (42, 42)).tocsr(), indices=[maze.goals["A"]])[0]
        assert least_cost(maze, maze.goals["A"], cost) == pytest.approx(wanted)

    def test_a_free_way_costs_nothing(self):
        assert least_cost(ROOM, 0, np.zeros((4, 5))).tolist() == [0, 0, 0, 0]


class TestPlans:
    @pytest.mark.parametrize("variant", VARIANTS)
    def test_the_cost_formulation_arrives_from_every_start_in_200_mazes(self, variant):
        for seed in range(200):
            rng = np.random.default_rng(seed)
            rows, cols, goals = (int(k) for k in rng.integers((5, 5, 2), (15, 15, 7)))
            maze = random_maze(rows, cols, goals, rng)
            how = Parameters(formulation="cost", variant=variant)
            assert plan_legible(maze, "A", how).certificate.arrives.all()

    @settings(max_examples=25, deadline=None)
    @given(seeds, st.sampled_from(["reward", "cost"]), st.sampled_from(VARIANTS), betas, gammas)
    def test_the_guard_certifies_for_any_beta_and_gamma(
        self, seed, formulation, variant, beta, gamma
    ):
        maze = random_maze(8, 9, 3, np.random.default_rng(seed))
        plan = plan_legible(maze, "B", Parameters(beta, gamma, formulation, variant, guard=True))
        assert plan.certificate.certified
        assert np.isfinite(plan.v_legible).all()

    @settings(max_examples=25, deadline=None)
    @given(seeds, st.sampled_from(["reward", "cost"]), st.sampled_from(VARIANTS))
    def test_a_mirrored_maze_has_the_mirrored_policy(self, seed, formulation, variant):
        maze = random_maze(6, 7, 3, np.random.default_rng(seed))
        mirrored = Maze(
            6,
            7,
            {k: x // 7 * 7 + 6 - x % 7 for k, x in maze.goals.items()},
            maze.wall_right[:, ::-1],
            maze.wall_below[:, ::-1],
        )
        how = Parameters(formulation=formulation, variant=variant)
        policy = plan_legible(maze, "C", how).policy_legible.reshape(6, 7, 5)
        again = plan_legible(mirrored, "C", how).policy_legible.reshape(6, 7, 5)
        assert np.array_equal(again[:, ::-1][..., [0, 1, 3, 2, 4]], policy)

    @settings(max_examples=25, deadline=None)
    @given(seeds, st.sampled_from(["reward", "cost"]), st.sampled_from(VARIANTS))
    def test_the_order_of_the_other_goals_does_not_matter(self, seed, formulation, variant):
        rng = np.random.default_rng(seed)
        maze = random_maze(6, 6, 4, rng)
        order = ["A", *rng.permutation(["B", "C", "D"])]
        shuffled = dict(zip("ABCD", (maze.goals[k] for k in order), strict=True))
        renamed = Maze(6, 6, shuffled, maze.wall_right, maze.wall_below)
        how = Parameters(formulation=formulation, variant=variant)
        one, other = plan_legible(maze, "A", how), plan_legible(renamed, "A", how)
        assert other.v_legible == pytest.approx(one.v_legible, abs=1e-12)
        assert np.array_equal(other.policy_legible, one.policy_legible)
