import csv
from dataclasses import replace

import numpy as np
import pytest

from policies import (
    ACTION_SETS,
    ModelError,
    ResultError,
    action_beliefs,
    goal_values,
    legible_rewards,
    measure_legibility,
    plan_legible,
    random_maze,
)
from policies.experiments import frameworks, scaling
from policies.experiments.comparison import Comparison, design_comparison
from policies.experiments.frameworks import play
from policies.experiments.scaling import (
    COLUMNS,
    compare_frameworks,
    open_comparison,
    play_pair,
)
from policies.experiments.tables import read_rows
from policies.experiments.worlds import World, draw_pairs, drawn_worlds

SMALL = Comparison("states", pairs=4, simulations=30, limit_s=60, seed=5)
TIMES = {"goal_solves_s", "planning_s"}


@pytest.fixture(scope="module")
def worlds():
    """Two small worlds."""
    shapes = {"4x4": (4, 4, 2), "5x6": (5, 6, 3)}
    return [
        World(name, random_maze(*shape, np.random.default_rng(9))) for name, shape in shapes.items()
    ]


@pytest.fixture(scope="module")
def serial(worlds, tmp_path_factory):
    """The file of an unbroken run of one worker."""
    store = open_comparison(tmp_path_factory.mktemp("serial"), worlds, SMALL)
    compare_frameworks(worlds, SMALL, store)
    return store.file


def untimed(file):
    """Rows without times, in one order."""
    with file.open(newline="", encoding="utf-8") as lines:
        rows = [{k: v for k, v in row.items() if k not in TIMES} for row in csv.DictReader(lines)]
    return sorted(rows, key=lambda row: (row["world"], int(row["pair"]), row["framework"]))


def test_every_framework_plays_every_pair_once(worlds, serial):
    rows = untimed(serial)
    played = [(row["world"], int(row["pair"]), row["framework"]) for row in rows]
    wanted = [
        (w.name, pair, f) for w in worlds for pair in range(4) for f in sorted(SMALL.frameworks)
    ]
    assert played == wanted
    for world in worlds:
        pairs = [(p.start, p.goal) for p in draw_pairs(world, 4, SMALL.seed)]
        for framework in SMALL.frameworks:
            of_it = [r for r in rows if (r["world"], r["framework"]) == (world.name, framework)]
            assert [(int(row["start"]), row["goal"]) for row in of_it] == pairs


def test_rows_say_what_happened(serial):
    rows = read_rows(serial)
    assert set(rows.columns) == {*COLUMNS, "time_s", "failed"}
    assert (rows["steps"] <= np.ceil(4 * rows["distance"] / 0.85)).all()
    assert (rows["goal_solves_s"] > 0).all()
    assert (rows["planning_s"] >= 0).all()
    arrived = rows.filter(arrived=True)
    assert (arrived["steps"] >= arrived["distance"]).all()
    assert (arrived["polmdp_per_step"].is_between(0, 1)).all()
    assert rows.filter(framework="optimal")["failed"].sum() == 0


def test_two_workers_find_the_same(worlds, serial, tmp_path):
    store = open_comparison(tmp_path, worlds, SMALL)
    compare_frameworks(worlds, SMALL, store, workers=2)
    assert untimed(store.file) == untimed(serial)


def test_a_dask_cluster_of_two_finds_the_same(worlds, serial, tmp_path):
    distributed = pytest.importorskip("distributed")
    store = open_comparison(tmp_path, worlds, SMALL)
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
    ) as cluster:
        compare_frameworks(worlds, SMALL, store, cluster=cluster.scheduler_address)
    assert untimed(store.file) == untimed(serial)


def test_the_seed_decides_pairs_and_plays(tmp_path):
    # Two cells and one goal leave one pair: what differs is how often an action fails.
    cells = [World("cells", random_maze(1, 2, 1, np.random.default_rng(0)))]
    steps = []
    for seed in (1, 2):
        comparison = Comparison("states", pairs=30, simulations=1, seed=seed)
        store = open_comparison(tmp_path / str(seed), cells, comparison)
        compare_frameworks(cells, comparison, store)
        steps.append(read_rows(store.file)["steps"].to_list())
    assert steps[0] != steps[1]
    world = drawn_worlds("states", 1)[0]
    assert draw_pairs(world, 9, seed=1) != draw_pairs(world, 9, seed=2)


class TestResume:
    @pytest.mark.parametrize("left", [1, 2, 5, 24])
    def test_a_killed_run_repeats_nothing_and_ends_with_the_same_rows(
        self, worlds, serial, tmp_path, left
    ):
        store = open_comparison(tmp_path, worlds, SMALL)
        lines = serial.read_bytes().splitlines(keepends=True)
        kept = b"".join(lines[: left + 1])
        store.file.write_bytes(kept + lines[left][:7])
        heard = []
        again = open_comparison(tmp_path, worlds, SMALL, resume=True)
        compare_frameworks(
            worlds, SMALL, again, progress=lambda done, total: heard.append((done, total))
        )
        assert again.file.read_bytes().startswith(kept)
        assert untimed(again.file) == untimed(serial)
        assert heard == [(done, 8) for done in range(left // 3, 9)]

    def test_a_finished_run_is_not_overwritten(self, worlds, serial):
        before = serial.read_bytes()
        with pytest.raises(ResultError, match="expected no results here"):
            open_comparison(serial.parent, worlds, SMALL)
        compare_frameworks(
            worlds, SMALL, open_comparison(serial.parent, worlds, SMALL, resume=True)
        )
        assert serial.read_bytes() == before

    def test_other_mazes_are_another_run(self, serial):
        with pytest.raises(ResultError, match="expected mazes"):
            open_comparison(serial.parent, drawn_worlds("states", 1)[:2], SMALL, resume=True)


def test_a_pair_that_runs_out_of_time_says_so(worlds, tmp_path):
    hasty = Comparison("states", pairs=2, simulations=10**5, limit_s=0.01)
    store = open_comparison(tmp_path, worlds, hasty)
    compare_frameworks(worlds, hasty, store)
    rows = read_rows(store.file)
    late = rows.filter(timed_out=True)
    assert set(late["framework"]) == {"lmdp"}
    assert late.height == 4
    assert late["failed"].all()


class TestTheChoices:
    CHOSEN = design_comparison(
        variants=["advantage", "proper_posterior"],
        beta=0.8,
        gamma=0.7,
        actions="udlrn",
        guard=True,
        distance="kl",
        observer_beta=2.0,
        simulations=5,
    )

    def rows(self, world, comparison):
        return play_pair(world, draw_pairs(world, 1, 1)[0], comparison.frameworks, comparison)

    def test_reach_every_measure(self, worlds, monkeypatch):
        ways = {}

        def heard(framework, maze, pair, comparison, rng):
            ways[framework] = play(framework, maze, pair, comparison, rng)
            return ways[framework]

        monkeypatch.setattr(scaling, "play", heard)
        maze, actions = worlds[1].maze, ACTION_SETS["udlrn"]
        q = goal_values(maze, 0.7, actions)
        r_leg = legible_rewards(q, 0.8, "proper_posterior")
        rows = self.rows(worlds[1], self.CHOSEN)
        assert [row["framework"] for row in rows] == [
            *("polmdp_proper_posterior", "polmdp_advantage", "lmdp", "optimal")
        ]
        for row in rows:
            way = ways[row["framework"]].rollout
            beliefs = action_beliefs(maze, q, way.states, way.actions, actions, beta=2.0)
            n = maze.goal_index(row["goal"])
            seen = measure_legibility(way, n, r_leg, beliefs, 0.7, "kl")
            assert row["polmdp"] == pytest.approx(seen.polmdp)
            assert row["lmdp"] == pytest.approx(seen.lmdp)

    def test_reach_every_plan(self, worlds, monkeypatch):
        planned = []

        def heard(maze, goal, parameters):
            planned.append(parameters)
            return plan_legible(maze, goal, parameters)

        monkeypatch.setattr(frameworks, "plan_legible", heard)
        frameworks.warm_up.cache_clear()
        self.rows(worlds[1], self.CHOSEN)
        assert set(planned) == set(self.CHOSEN.polmdps.values())
        assert {p.variant for p in planned} == {"proper_posterior", "advantage"}

    def test_end_a_run_after_the_most_moves(self, worlds):
        rows = self.rows(worlds[1], design_comparison(most_moves=1, simulations=5))
        assert {(row["steps"], row["arrived"]) for row in rows} == {(1, 0)}


def test_worlds_play_as_many_pairs_as_are_listed_for_each(worlds, tmp_path):
    lists = [
        replace(world, pairs=tuple(draw_pairs(world, count, 1)))
        for world, count in zip(worlds, (1, 3), strict=True)
    ]
    comparison = design_comparison(pairs=None, simulations=5)
    store = open_comparison(tmp_path, lists, comparison)
    heard = []
    compare_frameworks(lists, comparison, store, progress=lambda *done: heard.append(done))
    rows = read_rows(store.file).filter(framework="optimal")
    assert rows.select("world", "pair").rows() == [
        ("4x4", 0),
        *(("5x6", pair) for pair in range(3)),
    ]
    assert heard == [(done, 4) for done in range(5)]


def test_a_world_without_listed_or_drawn_pairs_is_refused(worlds, tmp_path):
    comparison = design_comparison(pairs=None)
    store = open_comparison(tmp_path, worlds, comparison)
    with pytest.raises(ModelError, match="4x4: expected listed pairs, or how many to draw"):
        compare_frameworks(worlds, comparison, store)
