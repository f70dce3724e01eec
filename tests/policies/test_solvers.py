import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog
from scipy.sparse import csr_array

from policies import (
    ACTION_SETS,
    MDP,
    ModelError,
    distances,
    evaluate,
    goal_values,
    maze_mdp,
    parse_maze,
    random_maze,
    shortest_path_policy,
    solve,
)
from policies.solvers import ties

ROW = parse_maze("+---+---+---+\n| A   .   B |\n+---+---+---+\n")


def random_mdp(seed: int, S: int = 6, A: int = 3, gamma: float = 0.9) -> MDP:
    rng = np.random.default_rng(seed)
    P = rng.random((A * S, S)) * (rng.random((A * S, S)) < 0.5) + np.tile(np.eye(S) * 0.1, (A, 1))
    return MDP(csr_array(P / P.sum(axis=1, keepdims=True)), rng.normal(size=(S, A)), gamma)


def linear_program(mdp: MDP) -> np.ndarray:
    """Optimal values as the least v with v >= r + gamma P v for every action."""
    S, A = mdp.r.shape
    here = np.tile(np.eye(S), (A, 1))
    found = linprog(
        np.ones(S),
        A_ub=mdp.gamma * mdp.P.toarray() - here,
        b_ub=-mdp.r.T.ravel(),
        bounds=(None, None),
        method="highs",
    )
    assert found.x is not None
    return found.x


def value_iteration(mdp: MDP, sweeps: int) -> np.ndarray:
    v = np.zeros(len(mdp.r))
    for _ in range(sweeps):
        v = mdp.q(v).max(axis=1)
    return mdp.q(v)


class TestGeneralSolver:
    @pytest.mark.parametrize("seed", range(5))
    def test_agrees_with_linear_programming(self, seed):
        mdp = random_mdp(seed)
        assert solve(mdp).v == pytest.approx(linear_program(mdp), abs=1e-8)

    @pytest.mark.parametrize("actions", ["udlr", "udlrn"])
    def test_agrees_with_linear_programming_on_a_maze(self, draw_maze, actions):
        mdp = maze_mdp(draw_maze(4, 4, 2), 5, 0.9, ACTION_SETS[actions])
        assert solve(mdp).v == pytest.approx(linear_program(mdp), abs=1e-7)

    @pytest.mark.parametrize("gamma", [0.0, 0.5, 0.95])
    def test_agrees_with_value_iteration(self, gamma):
        mdp = random_mdp(3, gamma=gamma)
        assert solve(mdp).q == pytest.approx(value_iteration(mdp, 1500), abs=1e-9)

    def test_certifies_its_error(self):
        solution = solve(random_mdp(1))
        assert 0 <= solution.bound < 1e-12

    def test_no_policy_of_a_tiny_mdp_is_better(self):
        mdp = random_mdp(8, S=3, A=2)
        values = []
        for code in range(2**3):
            policy = np.eye(2)[[code >> x & 1 for x in range(3)]]
            values.append(evaluate(mdp, policy))
        assert solve(mdp).v == pytest.approx(np.max(values, axis=0), abs=1e-12)

    def test_shares_exact_ties(self):
        P = csr_array(np.tile(np.eye(2), (3, 1)))
        solution = solve(MDP(P, np.array([[1.0, 1.0, 0.0], [0.0, 2.0, 2.0]]), 0.5))
        assert solution.policy.tolist() == [[0.5, 0.5, 0], [0, 0.5, 0.5]]

    @pytest.mark.parametrize("seed", range(20))
    def test_ends_where_rounding_decides(self, seed):
        rng = np.random.default_rng(seed)
        P = rng.dirichlet(np.ones(6), 18)
        # All actions are equal, at values where a relative difference of 0 is no tie.
        v = np.array([0.0, 0.0, 0.0, 1e3, -1e3, 500.0])
        r = (np.tile(v, 3) - 0.99 * P @ v).reshape(3, 6).T
        assert solve(MDP(csr_array(P), r, 0.99)).v == pytest.approx(v, abs=1e-8)

    @settings(max_examples=20)
    @given(st.integers(0, 10**6))
    def test_the_names_of_states_do_not_matter(self, seed):
        mdp = random_mdp(seed)
        S, A = mdp.r.shape
        order = np.random.default_rng(seed).permutation(S)
        P = mdp.P.toarray().reshape(A, S, S)[:, order][:, :, order].reshape(A * S, S)
        renamed = solve(MDP(csr_array(P), mdp.r[order], mdp.gamma))
        assert renamed.v == pytest.approx(solve(mdp).v[order], abs=1e-9)

    @settings(max_examples=20)
    @given(st.integers(0, 10**6), st.floats(0.1, 10), st.floats(-5, 5))
    def test_scaling_and_shifting_rewards_scales_and_shifts_values(self, seed, scale, shift):
        mdp = random_mdp(seed)
        other = solve(MDP(mdp.P, scale * mdp.r + shift, mdp.gamma))
        assert other.v == pytest.approx(scale * solve(mdp).v + shift / (1 - mdp.gamma), abs=1e-8)

    def test_evaluation_solves_the_linear_equations(self):
        chain = MDP(csr_array(np.array([[0.0, 1.0], [0.0, 1.0]])), np.array([[3.0], [1.0]]), 0.5)
        assert evaluate(chain, np.ones((2, 1))).tolist() == pytest.approx([4.0, 2.0])


class TestTies:
    def test_a_relative_difference_of_1e_12_is_a_tie_and_more_is_none(self):
        q = np.array([[1.0, 1 - 5e-13, 1 - 5e-12], [1e-9, 1e-9 * (1 - 5e-13), 0.99e-9]])
        assert ties(q).tolist() == [[True, True, False], [True, True, False]]

    def test_works_below_zero(self):
        assert ties(np.array([[-1.0, -1 - 5e-13, -1.1]])).tolist() == [[True, True, False]]

    def test_at_zero_only_equals_tie(self):
        assert ties(np.array([[0.0, 0.0, -1e-300]])).tolist() == [[True, True, False]]


class TestClosedForm:
    def test_agrees_with_the_reference(self, reference):
        q = goal_values(reference["parsed"], reference["gamma"], ACTION_SETS["udlrn"])
        assert q == pytest.approx(np.array(reference["q"]), abs=1e-8)

    @pytest.mark.parametrize("actions", ["udlr", "udlrn"])
    @pytest.mark.parametrize("gamma", [0.0, 0.5, 0.9, 0.99])
    @pytest.mark.parametrize("openness", [0.0, 0.3, 1.0])
    def test_agrees_with_the_general_solver(self, draw_maze, actions, gamma, openness):
        maze = draw_maze(6, 7, 3, seed=int(100 * gamma), openness=openness)
        q = goal_values(maze, gamma, ACTION_SETS[actions])
        for n, goal in enumerate(maze.goals.values()):
            general = solve(maze_mdp(maze, goal, gamma, ACTION_SETS[actions])).q
            assert q[n] == pytest.approx(general, abs=1e-8)

    def test_a_goal_without_walls_cannot_be_held_without_no_op(self):
        open_field = parse_maze(
            "+---+---+---+\n| .   .   . |\n+   +   +   +\n| .   A   . |\n+   +   +   +\n"
            "| .   .   . |\n+---+---+---+\n"
        )
        leaves = goal_values(open_field, 0.9, ACTION_SETS["udlr"])[0, 4].max()
        stays = goal_values(open_field, 0.9, ACTION_SETS["udlrn"])[0, 4].max()
        assert leaves < stays == pytest.approx(10)

    @pytest.mark.parametrize("shape", [(1, 1), (1, 7), (7, 1), (2, 1)])
    @pytest.mark.parametrize("actions", ["udlr", "udlrn"])
    def test_tiny_mazes_agree_with_the_general_solver(self, draw_maze, shape, actions):
        maze = draw_maze(*shape, 1)
        q = goal_values(maze, 0.9, ACTION_SETS[actions])
        general = solve(maze_mdp(maze, maze.goals["A"], 0.9, ACTION_SETS[actions])).q
        assert q[0] == pytest.approx(general, abs=1e-10)

    def test_gamma_is_checked(self):
        with pytest.raises(ModelError, match=r"gamma in \[0, 1\), came 1"):
            goal_values(ROW, 1.0, ACTION_SETS["udlr"])

    @settings(max_examples=15)
    @given(st.integers(0, 10**6))
    def test_a_mirrored_maze_has_mirrored_values(self, seed):
        maze = random_maze(4, 5, 2, np.random.default_rng(seed))
        mirrored = type(maze)(
            maze.rows,
            maze.cols,
            {k: (g // 5) * 5 + 4 - g % 5 for k, g in maze.goals.items()},
            maze.wall_right[:, ::-1],
            maze.wall_below[:, ::-1],
        )
        q = goal_values(maze, 0.9, ACTION_SETS["udlrn"]).reshape(2, 4, 5, 5)
        again = goal_values(mirrored, 0.9, ACTION_SETS["udlrn"]).reshape(2, 4, 5, 5)
        assert again[:, :, ::-1][..., [0, 1, 3, 2, 4]] == pytest.approx(q, abs=1e-12)


class TestShortestPaths:
    def test_distances_are_those_of_the_grid(self):
        assert distances(ROW).tolist() == [[0, 1, 2], [2, 1, 0]]

    def test_every_action_taken_lowers_the_distance_and_all_that_do_are_taken(self, draw_maze):
        maze = draw_maze(8, 8, 1, seed=4, openness=0.5)
        goal, d = maze.goals["A"], distances(maze)[0]
        policy = shortest_path_policy(maze, goal, ACTION_SETS["udlrn"])
        lowers = d[maze.successors] == d[:, None] - 1
        away = np.arange(64) != goal
        assert np.array_equal(policy[away] > 0, lowers[away])
        assert np.allclose(policy.sum(axis=1), 1)

    def test_at_the_goal_it_stays(self):
        policy = shortest_path_policy(ROW, 0, ACTION_SETS["udlrn"])
        assert policy[0].tolist() == [0.25, 0.25, 0.25, 0, 0.25]

    def test_is_exact_where_values_are_equal_to_machine_precision(self):
        cells = "   ".join(["A", *["."] * 399])
        corridor = parse_maze(f"+{'---+' * 400}\n| {cells} |\n+{'---+' * 400}\n")
        q = goal_values(corridor, 0.5, ACTION_SETS["udlrn"])[0]
        assert q[-1].max() < 1e-100
        policy = shortest_path_policy(corridor, 0, ACTION_SETS["udlrn"])
        assert (policy[1:, 2] == 1).all()

    def test_it_is_optimal_for_the_goals_mdp(self, draw_maze):
        maze = draw_maze(6, 6, 2, seed=9)
        mdp = maze_mdp(maze, maze.goals["B"], 0.9, ACTION_SETS["udlrn"])
        policy = shortest_path_policy(maze, maze.goals["B"], ACTION_SETS["udlrn"])
        assert evaluate(mdp, policy) == pytest.approx(solve(mdp).v, abs=1e-10)
