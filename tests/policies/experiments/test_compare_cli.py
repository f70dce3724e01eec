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

from policies import commands, format_maze, random_maze, read_mazes

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
        ([], "expected goals or states, or --mazes DIR; came none of them"),
        (["goals", "--preset", "authors", "--beta", "1"], "expected beta 0.5 with preset authors"),
        (["goals", "--variant", "x"], "expected variants in as_printed, proper_posterior"),
        (["states", "--pairs-file", "no-such-file"], "no-such-file: No such file or directory"),
        (["goals", "--pairs", "1", "--pairs-file", "f"], "expected either --pairs or --pairs-file"),
    ],
)
def test_bad_input_is_one_clear_line(arguments, said, tmp_path):
    result = run(*arguments, "--out", tmp_path / "new")
    assert result.exit_code == 2
    assert said in result.stderr
    assert "Traceback" not in result.output


def test_mazes_of_ones_own_need_no_test_and_their_pairs_may_be_listed(mazes, tmp_path):
    pairs = tmp_path / "pairs.csv"
    text = "maze,row,column,goal\nsmall,1,1,A\nsmall,1,1,B\nsmall,2,2,A\n"
    maze = read_mazes(mazes)["small"]
    assert not {0, 6} & set(maze.goals.values())
    pairs.write_text(text, encoding="utf-8")
    out = tmp_path / "out"
    arguments = ("--mazes", mazes, "--pairs-file", pairs, "--out", out, "--simulations", 9)
    result = run(*arguments)
    assert result.exit_code == 0, result.output
    rows = pl.read_csv(out / "mazes.csv")
    optimal = rows.filter(framework="optimal").sort("pair")
    assert set(rows["world"]) == {"small"}
    assert optimal.select("start", "goal").rows() == [(0, "A"), (0, "B"), (6, "A")]
    assert "listed pairs of start and goal" in result.stdout
    pairs.write_text(text.replace("2,2,A", "2,2,B"), encoding="utf-8")
    again = run(*arguments, "--resume")
    assert again.exit_code == 2
    assert "expected listed_pairs" in again.stderr


def test_all_variants_stand_in_one_table(mazes, tmp_path):
    result = run("--variant", "all", *QUICK, "--mazes", mazes, "--out", tmp_path / "new")
    assert result.exit_code == 0, result.output
    heads = "| world | PoLMDP | PoLMDP (proper posterior) | PoLMDP (advantage) | L-MDP |"
    assert heads in result.stdout
    assert "PoLMDP (proper posterior) against PoLMDP (advantage):" in result.stdout
    assert "PoLMDP (advantage)" in (tmp_path / "new" / "mazes-figure-lmdp.svg").read_text()
    means = pl.read_csv(tmp_path / "new" / "mazes-means.csv")
    assert means["framework"].n_unique() == 5


def design(result):
    """The paragraph that says what was run."""
    return result.stdout.split("\n\n")[1]


CHOICES = {
    "beta": ("--beta", "0.7", 0.7),
    "gamma": ("--gamma", "0.8", 0.8),
    "variants": ("--variant", "advantage", ["advantage"]),
    "formulation": ("--formulation", "cost", "cost"),
    "guard": ("--guard", None, True),
    "distance": ("--distance", "kl", "kl"),
    "observer_beta": ("--observer-beta", "2", 2.0),
    "actions": ("--actions", "udlrn", "udlrn"),
    "most_moves": ("--most-moves", "7", 7),
    "mode": ("--mode", "as_reported", "as_reported"),
    "preset": ("--preset", "authors", "authors"),
}


@pytest.mark.parametrize("name", CHOICES)
def test_a_choice_is_written_down_and_another_is_no_resumption(name, finished, mazes, tmp_path):
    option, value, stored = CHOICES[name]
    told = [option] if value is None else [option, value]
    out = tmp_path / "new"
    result = run("states", *told, *QUICK, "--mazes", mazes, "--out", out, "--workers", 1)
    assert result.exit_code == 0, result.output
    parameters = json.loads((out / "states.json").read_text(encoding="utf-8"))["parameters"]
    assert parameters[name] == stored
    assert design(result) != design(finished[1])
    refused = run("states", *QUICK, "--mazes", mazes, "--out", out, "--resume")
    assert refused.exit_code == 2
    assert f"{out / 'states.json'}: expected" in refused.stderr


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
