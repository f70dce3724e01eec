import csv

import numpy as np
import pytest

from policies import ModelError, ResultError, random_maze
from policies.experiments.frameworks import FRAMEWORKS
from policies.experiments.scaling import COLUMNS, Comparison, compare_frameworks, open_comparison
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
    wanted = [(w.name, pair, f) for w in worlds for pair in range(4) for f in sorted(FRAMEWORKS)]
    assert played == wanted
    for world in worlds:
        pairs = [(p.start, p.goal) for p in draw_pairs(world, 4, SMALL.seed)]
        for framework in FRAMEWORKS:
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


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"test": "walls"}, "expected a test in goals, states; came 'walls'"),
        ({"pairs": 0}, "expected at least 1 pair a world, came 0"),
        ({"mode": "x"}, "expected mode in miura, as_reported; came 'x'"),
        ({"simulations": 0}, "expected simulations of at least 1"),
        ({"limit_s": 0}, "expected a time limit above 0 s"),
    ],
)
def test_what_cannot_be_run_is_refused(wrong, said):
    with pytest.raises(ModelError, match=said):
        Comparison(**{"test": "goals", **wrong})
