"""Cells that reach no goal are no states of anything: all solvers and commands agree on that."""

import json
from typing import get_args

import numpy as np
import polars as pl
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import bellman_ford
from typer.testing import CliRunner

from policies import (
    ACTION_SETS,
    FAILURE,
    MDP,
    Learner,
    Maze,
    MazeError,
    ModelError,
    Parameters,
    certify,
    commands,
    distances,
    format_maze,
    goal_values,
    legible_rewards,
    maze_mdp,
    maze_rewards,
    maze_transitions,
    parse_maze,
    plan_legible,
    play_lmdp,
    pool_build,
    pool_check,
    shortest_path_policy,
    solve,
    solve_maze,
)
from policies.experiments.teaching import EXAMPLES, TeachingDesign, run_teaching
from policies.experiments.worlds import World, draw_pairs
from policies.maze_solver import Variant, least_cost
from policies.mdp import policy_transitions
from policies.polmdp import guard
from policies.pool_rule import candidates
from tests.policies.walls import random_rooms

ACTIONS = ACTION_SETS["udlrn"]
VARIANTS: tuple[Variant, ...] = get_args(Variant)
# The two cells on the right, and the one at the bottom left, reach no goal.
ROOMS = """\
+---+---+---+---+
| A   .   B | . |
+---+   +   +   +
| . | .   . | . |
+---+---+---+---+
"""
CLOSED = [3, 4, 7]

seeds = st.integers(0, 10**6)
action_sets = st.sampled_from(["udlr", "udlrn"])


@pytest.fixture
def rooms_file(tmp_path):
    """ROOMS as the only file of a folder."""
    path = tmp_path / "mazes" / "rooms.txt"
    path.parent.mkdir()
    path.write_text(ROOMS, encoding="utf-8")
    return path


def run(*arguments):
    result = CliRunner().invoke(commands, [str(a) for a in arguments])
    assert result.exit_code == 0, result.output
    return result.stdout


class TestRooms:
    @settings(max_examples=100, deadline=None)
    @given(seeds)
    def test_are_those_that_walking_finds(self, seed):
        maze, room = random_rooms(5, 6, 2, np.random.default_rng(seed))
        assert np.array_equal(maze.reaches_goal, room)
        free = room & ~np.isin(np.arange(30), list(maze.goals.values()))
        assert maze.free_cells.tolist() == np.flatnonzero(free).tolist()

    def test_a_text_with_closed_rooms_is_read_and_written_back(self):
        maze = parse_maze(ROOMS)
        assert np.flatnonzero(~maze.reaches_goal).tolist() == CLOSED
        assert format_maze(maze) == ROOMS

    def test_goals_may_share_a_room_without_another_cell(self):
        pair = parse_maze("+---+---+---+\n| A   B | . |\n+---+---+---+\n")
        assert pair.reaches_goal.tolist() == [True, True, False]
        assert len(pair.free_cells) == 0

    def test_no_way_between_goals_is_an_error_of_a_maze_made_otherwise(self):
        apart = Maze(1, 3, {"A": 0, "B": 2}, np.array([[False, True]]), np.zeros((0, 3), bool))
        with pytest.raises(MazeError, match="expected a way from goal B to A, found none"):
            distances(apart)


class TestValues:
    @settings(max_examples=40, deadline=None)
    @given(seeds, action_sets, st.sampled_from([0.0, 0.5, 0.9, 0.99]))
    def test_goal_values_are_those_of_the_general_solver_and_0_in_closed_rooms(
        self, seed, names, gamma
    ):
        maze, room = random_rooms(5, 6, 2, np.random.default_rng(seed))
        actions = ACTION_SETS[names]
        q = goal_values(maze, gamma, actions)
        for n, goal in enumerate(maze.goals.values()):
            assert q[n] == pytest.approx(solve(maze_mdp(maze, goal, gamma, actions)).q, abs=1e-9)
        assert (q[:, ~room] == 0).all()
        assert np.array_equal(distances(maze) >= 0, np.tile(room, (2, 1)))

    @settings(max_examples=60, deadline=None)
    @given(
        seeds,
        action_sets,
        st.sampled_from(VARIANTS),
        st.sampled_from([0.5, 1e4]),
        st.sampled_from([None, [0.7, 0.2, 0.1]]),
    )
    def test_legible_values_are_those_of_the_general_solver(
        self, seed, names, variant, beta, weights
    ):
        maze, room = random_rooms(5, 6, 3, np.random.default_rng(seed))
        actions = ACTION_SETS[names]
        prior = None if weights is None else np.array(weights)
        q, r_leg = maze_rewards(maze, 0.9, actions, beta, variant, prior)
        assert np.array_equal(q, goal_values(maze, 0.9, actions))
        wanted = legible_rewards(q, beta, variant, prior)[:, room]
        # beta Q is known to a relative 1e-16: the exponent's rounding is all that may differ.
        assert r_leg[:, room] == pytest.approx(wanted, rel=1e-12 + 1e-13 * beta, abs=1e-300)
        assert (r_leg[:, ~room] == 0).all()
        solution = solve_maze(maze, r_leg[1], 0.9, actions)
        general = solve(MDP(maze_transitions(maze, actions), r_leg[1], 0.9))
        assert solution.v == pytest.approx(general.v, abs=1e-9)
        assert (solution.v[~room] == 0).all()
        assert (solution.q[~room] == 0).all()

    @settings(max_examples=30, deadline=None)
    @given(seeds, action_sets)
    def test_least_costs_are_those_of_bellman_and_ford(self, seed, names):
        rng = np.random.default_rng(seed)
        maze, room = random_rooms(5, 6, 1, rng)
        after = maze.successors[:, list(ACTION_SETS[names])]
        cost = rng.random(after.shape)
        x, a = np.nonzero(after != np.arange(30)[:, None])
        edges = coo_array((cost[x, a] / (1 - FAILURE), (after[x, a], x)), (30, 30))
        wanted = bellman_ford(edges.tocsr(), indices=[maze.goals["A"]])[0]
        v = least_cost(maze, maze.goals["A"], cost)
        assert v[room] == pytest.approx(wanted[room])
        assert (v[~room] == 0).all()

    def test_a_learner_learns_the_same_as_without_the_rooms(self):
        maze, bare = parse_maze(ROOMS), parse_maze("+---+---+---+\n| A   .   B |\n+---+---+---+\n")
        closed = parse_maze(
            "+---+---+---+---+\n| A   .   B | . |\n+---+---+---+   +\n| .   .   .   . |\n"
            "+---+---+---+---+\n"
        )
        x, a = np.array([1, 1, 0]), np.array([2, 2, 4])
        for predictor in ("bayes", "gradient"):
            scores = Learner(closed, predictor).scores(x, a)
            assert scores == pytest.approx(Learner(bare, predictor).scores(x, a), abs=1e-9)
            assert np.isfinite(Learner(maze, predictor).scores(x, a)).all()


class TestPlans:
    @settings(max_examples=60, deadline=None)
    @given(
        seeds,
        st.sampled_from(["reward", "cost"]),
        st.sampled_from(VARIANTS),
        action_sets,
        st.sampled_from([(0.5, 0.9), (0.5, 0.3), (50.0, 0.99)]),
    )
    def test_are_certified_from_every_start_that_reaches_the_goal(
        self, seed, formulation, variant, names, beta_and_gamma
    ):
        beta, gamma = beta_and_gamma
        maze, room = random_rooms(6, 7, 3, np.random.default_rng(seed))
        how = Parameters(beta, gamma, formulation, variant, names, guard=True)
        plan = plan_legible(maze, "B", how)
        for policy in (plan.policy_legible, plan.policy_optimal):
            assert policy.sum(axis=1) == pytest.approx(np.ones(42))
        assert (plan.v_legible[~room] == 0).all()
        assert not plan.repaired[~room].any()
        proof = plan.certificate
        assert proof.certified
        assert np.array_equal(proof.arrives, room)
        assert np.isinf(proof.stretch[~room]).all()
        assert np.isinf(proof.expected_steps[~room]).all()
        assert proof.stretch[room].max() <= 4

    @settings(max_examples=60, deadline=None)
    @given(seeds)
    def test_the_certificate_of_any_policy_is_that_of_brute_force(self, seed):
        rng = np.random.default_rng(seed)
        maze, room = random_rooms(5, 6, 1, rng)
        goal = maze.goals["A"]
        chosen = np.argsort(rng.random((30, 5)), axis=1) < 2
        optimal = shortest_path_policy(maze, goal, ACTIONS)
        policy = np.where(rng.random((30, 1)) < 0.7, optimal, chosen / 2)
        chain = policy_transitions(maze_transitions(maze, ACTIONS), policy).toarray()
        chain[goal] = np.eye(30)[goal]
        reached = np.linalg.matrix_power(chain + np.eye(30), 30) > 0
        arrives = ~reached[:, ~reached[:, goal]].any(axis=1)
        steps = np.full(30, np.inf)
        way = arrives & (np.arange(30) != goal)
        leave = np.eye(way.sum()) - chain[np.ix_(way, way)]
        steps[way], steps[goal] = np.linalg.solve(leave, np.ones(way.sum())), 0
        certificate = certify(maze, policy, goal, ACTIONS)
        assert np.array_equal(certificate.arrives, arrives)
        assert certificate.expected_steps == pytest.approx(steps, rel=1e-9)
        # A stretch of 4 itself is on either side, by rounding.
        assume(abs(certificate.stretch - 4)[room].min() > 1e-9)
        holds = steps <= 4 * distances(maze)[0] / (1 - FAILURE)
        assert certificate.certified == holds[room].all()
        repaired = guard(maze, goal, policy, optimal, ACTIONS)[1]
        assert np.array_equal(repaired, room & ~holds)


class TestStarts:
    WORLD = World("rooms", parse_maze(ROOMS))

    def test_no_pair_starts_in_a_closed_room(self):
        pairs = draw_pairs(self.WORLD, 400, seed=1)
        assert {(p.start, p.goal) for p in pairs} == {
            (start, letter)
            for letter, goal in self.WORLD.maze.goals.items()
            for start in {0, 1, 2, 5, 6} - {goal}
        }

    def test_no_search_starts_there(self):
        with pytest.raises(ModelError, match="expected a start with a way to the goals, came 4"):
            play_lmdp(self.WORLD.maze, 4, "A", np.random.default_rng(0))

    def test_no_stimulus_starts_there(self):
        assert {c.start for c in candidates(self.WORLD.maze, "rooms")} == {1, 5, 6}

    @pytest.mark.parametrize("lessons", ["samples", "sequences"])
    def test_no_lesson_shows_them(self, lessons, tmp_path, monkeypatch):
        shown = []

        def look(_learner, x, _a, _rng):
            shown.extend(x.tolist())
            return np.zeros(EXAMPLES, int)

        monkeypatch.setattr(Learner, "guesses", look)
        design = TeachingDesign(lessons, units=30)
        run_teaching(design, {"rooms": self.WORLD.maze}, tmp_path)
        assert set(shown) == {0, 1, 2, 5, 6}

    def test_a_room_of_goals_alone_teaches_nothing(self, tmp_path):
        pair = parse_maze("+---+---+---+\n| A   B | . |\n+---+---+---+\n")
        with pytest.raises(MazeError, match="a cell without one, came 2 goals in 2 cells"):
            run_teaching(TeachingDesign("samples"), {"pair": pair}, tmp_path)


class TestCommands:
    def test_solve_says_which_cells_reach_no_goal_and_leaves_them_blank(self, rooms_file, tmp_path):
        to = tmp_path / "solved.json"
        said = run("solve", rooms_file, "--goal", "A", "--json", to)
        assert "of the 4 starts that arrive" in said
        assert "certified: arrives from every start that reaches the goal, with at most" in said
        assert "3 cells reach no goal (blank above): no start, and all values there are 0" in said
        assert said.splitlines()[2:4] == [
            "|A  ←  B |  |         |A  ←  B |  |",
            "+--+  +  +  +         +--+  +  +  +",
        ]
        assert said.splitlines()[4].startswith("|  |↑ ")
        solved = json.loads(to.read_text(encoding="utf-8"))
        assert np.flatnonzero(np.logical_not(solved["arrives"])).tolist() == CLOSED
        assert solved["reaches_goal"] == solved["arrives"]
        assert [x for x, s in enumerate(solved["stretch"]) if s is None] == CLOSED
        assert np.abs(np.array(solved["v_legible"])[CLOSED]).max() == 0

    def test_solve_counts_only_starts_that_could_arrive(self, rooms_file, draw_maze):
        maze = wall_in(draw_maze(25, 25, 3, seed=1))
        rooms_file.write_text(format_maze(maze), encoding="utf-8")
        said = run("solve", rooms_file, "--goal", "A", "--gamma", "0.5")
        holds = plan_legible(maze, "A", Parameters(gamma=0.5)).certificate.holds_at
        fails = np.flatnonzero(maze.reaches_goal & ~holds)
        i, j = maze.cell(int(fails[0]))
        assert f"from {len(fails)} of 623 starts, row {i + 1} column {j + 1} the first" in said
        assert "1 cell reaches no goal (blank above)" in said

    @pytest.mark.parametrize("mode", ["miura", "as_reported"])
    def test_compare_plays_them(self, rooms_file, tmp_path, mode):
        few = ("--pairs", 6, "--simulations", 20, "--workers", 1, "--mode", mode)
        run("compare", "states", *few, "--mazes", rooms_file.parent, "--out", tmp_path / "out")
        rows = pl.read_csv(tmp_path / "out" / "states.csv")
        assert rows.height == 18
        assert not set(rows["start"]) & set(CLOSED)
        assert (rows["distance"] > 0).all()

    @pytest.mark.parametrize("predictor", ["bayes", "gradient"])
    @pytest.mark.parametrize("lessons", [("samples", "--sets"), ("sequences", "--starts")])
    def test_teach_teaches_in_them(self, rooms_file, tmp_path, lessons, predictor):
        few = (*lessons, 2, "--predictor", predictor, "--workers", 1)
        said = run("teach", *few, "--mazes", rooms_file.parent, "--out", tmp_path / "out")
        assert said.startswith("| k | PoLMDP")

    def test_stimuli_are_built_and_checked_in_them(self, tmp_path, monkeypatch):
        closed = {name: wall_in(maze) for name, maze in pool_build.package_mazes().items()}
        monkeypatch.setattr(pool_build, "package_mazes", lambda: closed)
        monkeypatch.setattr(pool_check, "package_mazes", lambda: closed)
        run("stimuli", "build", "--to", tmp_path)
        assert "arrive from every start" in run("stimuli", "check", tmp_path)
        pool = json.loads((tmp_path / "pool.json").read_text(encoding="utf-8"))
        for s in pool["stimuli"]:
            assert closed[s["maze"]].reaches_goal[s["cells"]].all()
        first = pool["scenarios"][0]
        first["start"] = int(np.flatnonzero(~closed[first["maze"]].reaches_goal)[0])
        (tmp_path / "pool.json").write_text(json.dumps(pool), encoding="utf-8")
        result = CliRunner().invoke(commands, ["stimuli", "check", str(tmp_path)])
        assert result.exit_code == 2
        assert "s01: expected a start outside the areas, with a way to them" in result.stderr


def wall_in(maze: Maze) -> Maze:
    """The maze with its first free cell walled in whose loss cuts off no other."""
    for x in maze.free_cells.tolist():
        i, j = maze.cell(x)
        right, below = maze.wall_right.copy(), maze.wall_below.copy()
        right[i, max(j - 1, 0) : j + 1] = True
        below[max(i - 1, 0) : i + 1, j] = True
        walled = Maze(maze.rows, maze.cols, maze.goals, right, below)
        if walled.reaches_goal.sum() == maze.states - 1:
            return walled
    raise AssertionError("every cell is a passage")
