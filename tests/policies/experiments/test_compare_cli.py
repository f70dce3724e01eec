import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import polars as pl
import pytest
from typer.testing import CliRunner

from policies import commands, format_maze, random_maze

QUICK = ("--pairs", "3", "--simulations", "20")


def run(*arguments):
    return CliRunner().invoke(commands, ["compare", *(str(a) for a in arguments)])


@pytest.fixture(scope="module")
def mazes(tmp_path_factory):
    """A folder with two small mazes."""
    folder = tmp_path_factory.mktemp("mazes")
    for name, rows in (("small", 4), ("long corridor of my own", 6)):
        maze = random_maze(rows, 5, 3, np.random.default_rng(rows))
        (folder / f"{name}.txt").write_text(format_maze(maze), encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def finished(mazes, tmp_path_factory):
    """A finished run: its folder and what was printed."""
    out = tmp_path_factory.mktemp("runs") / "new"
    result = run("states", *QUICK, "--mazes", mazes, "--out", out, "--workers", 1)
    assert result.exit_code == 0, result.output
    return out, result


def test_a_run_leaves_rows_tables_figures_and_a_reading(finished):
    out, result = finished
    figures = {
        f"states-figure-{name}.{end}"
        for name in ("polmdp", "lmdp", "time")
        for end in ("svg", "png", "csv")
    }
    tables = {f"states-{name}.csv" for name in ("means", "failures", "differences", "ratios")}
    assert {path.name for path in out.iterdir()} == {
        *figures,
        *tables,
        *("states.csv", "states.json", "states.md"),
    }
    assert result.stdout.startswith("# Frameworks compared: states")
    assert (out / "states.md").read_text(encoding="utf-8").startswith(result.stdout.rstrip())


def test_mazes_of_ones_own_are_worlds_named_by_their_files(finished):
    out, _ = finished
    rows = pl.read_csv(out / "states.csv")
    assert set(rows["world"]) == {"small", "long corridor of my own"}
    assert rows.height == 2 * 3 * 3


def test_the_description_names_what_was_run(finished, mazes):
    out, _ = finished
    parameters = json.loads((out / "states.json").read_text(encoding="utf-8"))["parameters"]
    wanted = {"test": "states", "pairs": 3, "simulations": 20, "limit_s": 60, "mode": "miura"}
    assert wanted.items() <= parameters.items()
    assert set(parameters["mazes"]) == {path.stem for path in mazes.iterdir()}


def test_a_finished_run_is_not_overwritten(finished, mazes):
    out, _ = finished
    result = run("states", *QUICK, "--mazes", mazes, "--out", out)
    assert result.exit_code == 2
    assert "expected no results here" in result.stderr
    again = run("states", *QUICK, "--mazes", mazes, "--out", out, "--resume")
    assert again.exit_code == 0
    assert again.stdout == finished[1].stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["walls"], "expected a test in goals, states; came 'walls'"),
        (["goals", "--mode", "x"], "expected mode in miura, as_reported"),
        (["goals", "--pairs", "0"], "expected at least 1 pair a world"),
        (["goals", "--mazes", "no-such-folder"], "no-such-folder: expected a folder with maze"),
        (["goals", "--dask", "nowhere"], "expected a dask scheduler at nowhere"),
    ],
)
def test_bad_input_is_one_clear_line(arguments, said, tmp_path):
    result = run(*arguments, "--out", tmp_path / "new")
    assert result.exit_code == 2
    assert said in result.stderr
    assert "Traceback" not in result.output


def test_help_has_an_example():
    result = run("--help")
    assert result.exit_code == 0
    assert "goalguess compare states --pairs 20 --simulations 1000" in " ".join(
        result.stdout.replace("│", " ").split()
    )


def test_a_killed_run_is_resumed_without_repeating_a_pair(mazes, tmp_path):
    command = [sys.executable, "-m", "policies", "compare", "states", "--pairs", "25"]
    command += ["--simulations", "1000", "--mazes", str(mazes), "--out", str(tmp_path)]
    rows = tmp_path / "states.csv"
    with subprocess.Popen(
        [*command, "--workers", "1"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    ) as killed:
        while killed.poll() is None and (not rows.exists() or rows.read_bytes().count(b"\n") < 8):
            time.sleep(0.01)
        os.killpg(killed.pid, signal.SIGKILL)
    kept = rows.read_bytes()
    whole = kept[: kept.rfind(b"\n") + 1]
    assert 8 <= whole.count(b"\n") < 150
    subprocess.run([*command, "--resume"], check=True, capture_output=True)
    assert rows.read_bytes().startswith(whole)
    keys = pl.read_csv(rows).select("world", "pair", "framework")
    assert keys.height == keys.unique().height == 2 * 25 * 3
