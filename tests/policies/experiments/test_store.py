import json
import os
import subprocess
import sys

import pytest

from policies import ResultError, Store

PARAMETERS = {"seed": 1, "sizes": [5, 8], "limit": 0.5}
COLUMNS = ("world", "pair", "value")


def opened(folder, *, resume=False, **changed):
    return Store(folder, "run", {**PARAMETERS, **changed}, COLUMNS, resume=resume)


def row(world, pair, value=0.5):
    return {"value": value, "world": world, "pair": pair}


def test_rows_are_written_in_the_order_of_the_columns(tmp_path):
    store = opened(tmp_path / "made" / "here")
    store.append([row("5x8", 0, 1 / 3), row("a, b", 1, "")])
    store.append([row("5x8", 2, True)])
    assert store.file.read_text(encoding="utf-8") == (
        'world,pair,value\n5x8,0,0.3333333333333333\n"a, b",1,\n5x8,2,True\n'
    )


def test_the_description_holds_parameters_columns_and_versions(tmp_path):
    opened(tmp_path)
    run = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    assert run["parameters"] == PARAMETERS
    assert run["columns"] == list(COLUMNS)
    assert {"python", "goalguess", "numpy", "scipy"} <= set(run["versions"])


def test_done_gives_the_keys_of_all_rows_as_text(tmp_path):
    store = opened(tmp_path)
    assert store.done(["world"]) == set()
    store.append([row("5x8", 0), row("5x8", 1)])
    assert store.done(["world", "pair"]) == {("5x8", "0"), ("5x8", "1")}
    assert store.done(["world"]) == {("5x8",)}


def test_what_is_appended_is_on_the_disk_when_it_returns(tmp_path, monkeypatch):
    store = opened(tmp_path)
    synced = []
    monkeypatch.setattr("os.fsync", lambda file: synced.append(os.fstat(file).st_size))
    store.append([row("5x8", 0), row("5x8", 1)])
    assert synced == [store.file.stat().st_size]


@pytest.mark.parametrize("wrong", [{"world": "5x8", "pair": 1}, {**row("5x8", 1), "more": 2}])
def test_a_row_has_exactly_the_columns(tmp_path, wrong):
    store = opened(tmp_path)
    with pytest.raises(ResultError, match="expected cells for world, pair, value; came"):
        store.append([row("5x8", 0), wrong])
    assert store.done(["pair"]) == set()


def test_results_are_never_overwritten(tmp_path):
    opened(tmp_path).append([row("5x8", 0)])
    before = (tmp_path / "run.csv").read_bytes()
    with pytest.raises(ResultError, match=r"run\.csv: expected no results here"):
        opened(tmp_path)
    assert (tmp_path / "run.csv").read_bytes() == before


@pytest.mark.parametrize("resume", [False, True])
def test_rows_without_a_description_are_refused(tmp_path, resume):
    (tmp_path / "run.csv").write_text("mine\n", encoding="utf-8")
    with pytest.raises(ResultError, match="expected no results here"):
        opened(tmp_path, resume=resume)
    assert (tmp_path / "run.csv").read_text(encoding="utf-8") == "mine\n"


def test_two_runs_share_a_folder_under_two_names(tmp_path):
    opened(tmp_path).append([row("5x8", 0)])
    other = Store(tmp_path, "other", PARAMETERS, COLUMNS)
    assert other.done(["pair"]) == set()


class TestResume:
    def test_a_run_that_never_began_begins(self, tmp_path):
        assert opened(tmp_path, resume=True).done(["pair"]) == set()

    def test_rows_stay_and_new_ones_follow(self, tmp_path):
        opened(tmp_path).append([row("5x8", 0)])
        again = opened(tmp_path, resume=True)
        again.append([row("5x8", 1)])
        assert len(again.file.read_text(encoding="utf-8").splitlines()) == 3

    @pytest.mark.parametrize("lost", range(1, 12))
    def test_half_a_line_is_dropped_and_only_that(self, tmp_path, lost):
        store = opened(tmp_path)
        store.append([row("5x8", 0)])
        whole = store.file.read_bytes()
        store.append([row("10x10", 1)])
        store.file.write_bytes(store.file.read_bytes()[:-lost])
        opened(tmp_path, resume=True)
        assert store.file.read_bytes() == whole

    @pytest.mark.parametrize("left", [None, b"", b"world,pa"])
    def test_a_run_killed_before_its_header_gets_one(self, tmp_path, left):
        store = opened(tmp_path)
        store.file.unlink()
        if left is not None:
            store.file.write_bytes(left)
        opened(tmp_path, resume=True)
        assert store.file.read_text(encoding="utf-8") == "world,pair,value\n"

    @pytest.mark.parametrize(
        ("changed", "said"),
        [
            ({"seed": 2}, "expected seed 1 to resume, came 2"),
            ({"sizes": (5, 9)}, r"expected sizes \[5, 8\] to resume, came \[5, 9\]"),
            ({"more": 1}, "expected more None to resume, came 1"),
        ],
    )
    def test_other_parameters_are_refused_by_name(self, tmp_path, changed, said):
        opened(tmp_path)
        with pytest.raises(ResultError, match=said):
            opened(tmp_path, resume=True, **changed)

    def test_other_columns_are_refused(self, tmp_path):
        opened(tmp_path)
        with pytest.raises(ResultError, match="expected columns"):
            Store(tmp_path, "run", PARAMETERS, ("world", "pair"), resume=True)

    def test_other_versions_are_refused(self, tmp_path, monkeypatch):
        opened(tmp_path)
        monkeypatch.setattr("policies.experiments.store.version", lambda name: f"{name} 0")
        with pytest.raises(ResultError, match="expected version of goalguess"):
            opened(tmp_path, resume=True)

    @pytest.mark.parametrize("text", ["", "{", "[]", "{}", '{"parameters": 1}'])
    def test_a_broken_description_is_named(self, tmp_path, text):
        opened(tmp_path)
        (tmp_path / "run.json").write_text(text, encoding="utf-8")
        with pytest.raises(ResultError, match=r"run\.json: expected the description of a run"):
            opened(tmp_path, resume=True)


def test_rows_survive_a_kill_right_after_append(tmp_path):
    code = (
        "import os, sys; from pathlib import Path; from policies import Store;"
        "store = Store(Path(sys.argv[1]), 'run', {}, ['pair']);"
        "store.append([{'pair': 7}]); os.kill(os.getpid(), 9)"
    )
    done = subprocess.run([sys.executable, "-c", code, str(tmp_path)], check=False)
    assert done.returncode == -9
    assert Store(tmp_path, "run", {}, ["pair"], resume=True).done(["pair"]) == {("7",)}
