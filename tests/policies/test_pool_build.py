import json
from collections import Counter
from importlib.resources import files

import numpy as np
import pytest
from scipy import stats

from policies import (
    ACTION_SETS,
    MDP,
    format_maze,
    goal_values,
    load_pool,
    maze_transitions,
    movement_beliefs,
    parse_maze,
    steps_until_sure,
)
from policies.pool_build import (
    as_lines,
    build,
    mean_with_interval,
    package_mazes,
    passing,
    prediction,
    scene,
)
from policies.pool_rule import MAZES, Planner, candidates, fault
from policies.solvers import solve

POOL = load_pool()
MANIFEST = json.loads(
    files("policies").joinpath("stimuli/manifest.json").read_text(encoding="utf-8")
)


@pytest.fixture(scope="module")
def built():
    """The files that the committed seed builds."""
    return build(2209)


class TestScenes:
    def test_walls_are_merged_into_straight_lines(self):
        lid, hall = "+---+---+", "+   +   +"
        lines = [lid, "| A | B |", hall, "| . | . |", hall, "| .   . |", "+   +---+", "| .   . |"]
        across = [[0, 0, 2, 0], [1, 3, 2, 3], [0, 4, 2, 4]]
        down = [[0, 0, 0, 4], [1, 0, 1, 2], [2, 0, 2, 4]]
        assert scene(parse_maze("\n".join([*lines, lid]))) == {
            "rows": 4,
            "cols": 2,
            "walls": across + down,
            "areas": {"A": 0, "B": 1},
        }

    @pytest.mark.parametrize("name", sorted(package_mazes()))
    def test_every_unit_of_wall_is_drawn_once_and_no_opening_is(self, name):
        maze = package_mazes()[name]
        units = Counter[tuple[str, int, int]]()
        for x1, y1, x2, y2 in scene(maze)["walls"]:
            for k in range(max(x2 - x1, y2 - y1)):
                units["-" if y1 == y2 else "|", x1 + k * (y1 == y2), y1 + k * (x1 == x2)] += 1
        wanted = {("|", j + 1, i) for i, j in zip(*np.nonzero(maze.wall_right), strict=True)}
        wanted |= {("-", j, i + 1) for i, j in zip(*np.nonzero(maze.wall_below), strict=True)}
        wanted |= {("-", j, i) for j in range(maze.cols) for i in (0, maze.rows)}
        wanted |= {("|", j, i) for i in range(maze.rows) for j in (0, maze.cols)}
        assert units == Counter(wanted)


class TestMazes:
    def test_the_four_are_different_10_by_10_with_six_goals(self):
        mazes = [package_mazes()[name] for name in MAZES]
        assert len({format_maze(maze) for maze in mazes}) == 4
        for maze in mazes:
            assert (maze.rows, maze.cols, maze.letters) == (10, 10, tuple("ABCDEF"))

    def test_no_tie_of_a_legible_policy_hangs_on_rounding(self):
        planner = Planner(package_mazes(), 0)
        for name in MAZES:
            for goal in "ABCDEF":
                plan = planner.plan(name, goal)
                n = plan.maze.goal_index(goal)
                P = maze_transitions(plan.maze, ACTION_SETS["udlrn"])
                q = solve(MDP(P, plan.r_leg[n], 0.9)).q
                gap = 1 - q / q.max(axis=1, keepdims=True)
                assert not ((gap > 1e-13) & (gap < 1e-9)).any()


class TestBuilding:
    def test_gives_the_committed_bytes(self, built):
        folder = files("policies").joinpath("stimuli")
        for name, text in built.items():
            assert folder.joinpath(name).read_bytes() == text.encode("utf-8")

    def test_another_seed_gives_another_pool_and_says_so_on_the_way(self, built):
        said: list[str] = []
        other = json.loads(build(1, progress=said.append)["pool.json"])
        assert len(said) == len(MAZES)
        pool = json.loads(built["pool.json"])
        assert other["scenes"] == pool["scenes"]
        assert other["scenarios"] != pool["scenarios"]
        assert not {s["id"] for s in other["stimuli"]} & {s["id"] for s in pool["stimuli"]}

    def test_what_passes_is_what_keeps_the_rule(self):
        planner = Planner(package_mazes(), 3)
        name = MAZES[0]
        kept = set(passing(planner, name))
        for candidate in candidates(planner.mazes[name], name)[::9]:
            pair = [planner.draw(candidate, c) for c in ("polmdp", "optimal")]
            assert (fault(pair, planner.goal(candidate)) is None) == (candidate in kept)

    def test_a_file_has_one_line_per_entry(self):
        text = as_lines({"a": 1, "b": [[1, 2], {"c": 3}], "d": {"e": [4], "f": 5}})
        assert json.loads(text) == {"a": 1, "b": [[1, 2], {"c": 3}], "d": {"e": [4], "f": 5}}
        assert len(text.splitlines()) == 11
        assert text.endswith("}\n")


class TestManifest:
    def test_names_seed_parameters_and_pool(self):
        assert MANIFEST["seed"] == 2209
        assert MANIFEST["pool_sha256"] == POOL.hash
        assert MANIFEST["parameters"] == {
            "beta": 0.5,
            "gamma": 0.9,
            "formulation": "reward",
            "variant": "as_printed",
            "actions": "udlrn",
            "guard": True,
            "failure": 0.15,
            "beta_observer": 5.0,
        }

    def test_belief_curves_are_those_of_the_movement_only_observer(self):
        mazes = package_mazes()
        assert set(MANIFEST["belief_in_true_goal"]) == set(POOL.stimuli)
        for key, curve in MANIFEST["belief_in_true_goal"].items():
            shown = POOL.stimuli[key]
            maze = mazes[shown.maze]
            q = goal_values(maze, 0.9, ACTION_SETS["udlrn"])
            cells = np.array(shown.cells)
            beliefs = movement_beliefs(maze, q, cells, ACTION_SETS["udlrn"], beta=5.0)
            assert curve == pytest.approx(beliefs[:, maze.goal_index(shown.goal)], abs=1e-6)
            assert curve[0] == pytest.approx(1 / 6, abs=1e-6)

    def test_the_saving_is_that_of_the_curves(self):
        sure = {}
        for shown in POOL.stimuli.values():
            curve = np.array(MANIFEST["belief_in_true_goal"][shown.id])
            sure[shown.scenario, shown.condition] = steps_until_sure(curve[:, None], 0, 0.8)
        saved = [sure[s.id, "optimal"] - sure[s.id, "polmdp"] for s in POOL.scenarios]
        stated = MANIFEST["prediction"]["saving_steps"]
        assert stated["mean"] == pytest.approx(np.mean(saved), abs=1e-4)
        low, high = stats.ttest_1samp(saved, 0).confidence_interval(0.95)
        assert (stated["low"], stated["high"]) == pytest.approx((low, high), abs=1e-4)

    def test_the_baseline_is_that_of_the_listed_steps(self):
        rows = MANIFEST["steps_until_sure"]
        apart = [row["optimal"] - row["optimal again"] for row in rows]
        assert len(apart) == 37
        assert MANIFEST["prediction"]["baseline_steps"]["mean"] == pytest.approx(
            np.mean(apart), abs=1e-4
        )

    def test_the_saving_is_clearly_above_the_baseline(self):
        stated = MANIFEST["prediction"]
        assert stated["saving_steps"]["low"] > stated["baseline_steps"]["high"]

    def test_the_interval_is_that_of_t(self):
        values = np.array([1.0, 4.0, 2.0, 2.0, 7.0])
        low, high = stats.ttest_1samp(values, 0).confidence_interval(0.95)
        stated = mean_with_interval(values)
        assert (stated["low"], stated["high"]) == pytest.approx((low, high), abs=1e-4)

    def test_percent_is_of_the_steps_that_the_optimal_policy_needs(self):
        steps = {
            "optimal": np.array([10.0, 10.0]),
            "polmdp": np.array([9.0, 6.0]),
            "optimal again": np.array([11.0, 9.0]),
        }
        stated = prediction(steps)
        assert stated["saving_percent"] == 25
        assert stated["baseline_steps"]["mean"] == 0
