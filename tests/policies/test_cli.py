import json
import subprocess
import sys

import numpy as np
import pytest
from typer.testing import CliRunner

from policies import Parameters, commands, format_maze, load_pool, plan_legible, read_maze
from policies.cli import DATA

POOL = load_pool()


def run(*arguments):
    return CliRunner().invoke(commands, [str(a) for a in arguments])


def fails_with(said: str, *arguments) -> None:
    """Exit code 2, one line on stderr, nothing on stdout, no traceback."""
    result = run(*arguments)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("goalguess: ")
    assert said in result.stderr
    assert result.stderr.count("\n") == 1


class TestSolve:
    def test_prints_both_maps_expected_steps_and_certificate(self, maze_file):
        result = run("solve", maze_file, "--goal", "A")
        assert result.exit_code == 0
        for said in ("optimal policy to A", "legible policy to A", "expected steps", "certified"):
            assert said in result.stdout

    @pytest.mark.parametrize(
        ("options", "parameters"),
        [
            ([], Parameters()),
            (["--beta", "2", "--gamma", "0.5"], Parameters(beta=2, gamma=0.5)),
            (["--formulation", "cost"], Parameters(formulation="cost")),
            (["--variant", "advantage"], Parameters(variant="advantage")),
            (["--actions", "udlr"], Parameters(actions="udlr")),
            (["--guard", "--gamma", "0.3"], Parameters(gamma=0.3, guard=True)),
        ],
    )
    def test_the_json_holds_what_the_library_computes(
        self, maze_file, tmp_path, options, parameters
    ):
        to = tmp_path / "solved.json"
        assert run("solve", maze_file, "--goal", "B", "--json", to, *options).exit_code == 0
        solved = json.loads(to.read_text(encoding="utf-8"))
        plan = plan_legible(read_maze(maze_file), "B", parameters)
        assert solved["goals"] == ["A", "B", "C"]
        assert solved["prior"] == [1 / 3, 1 / 3, 1 / 3]
        for key in ("q", "r_leg", "v_legible", "policy_optimal", "policy_legible"):
            assert np.array_equal(solved[key], getattr(plan, key))
        actions = 4 if parameters.actions == "udlr" else 5
        assert np.shape(solved["q"]) == np.shape(solved["r_leg"]) == (3, 20, actions)
        assert np.shape(solved["policy_legible"]) == (20, actions)
        assert solved["reaches_goal"] == [True] * 20
        assert solved["arrives"] == plan.certificate.arrives.tolist()
        stretch = [np.inf if s is None else s for s in solved["stretch"]]
        assert stretch == plan.certificate.stretch.tolist()
        assert len(solved) == 10

    def test_a_prior_is_divided_by_its_sum_shown_and_planned_with(self, maze_file, tmp_path):
        to = tmp_path / "solved.json"
        result = run("solve", maze_file, "--goal", "B", "--prior", "B=4, A=2,C=2", "--json", to)
        assert result.exit_code == 0
        assert "\nprior: A 0.25, B 0.5, C 0.25\n" in result.stdout
        solved = json.loads(to.read_text(encoding="utf-8"))
        plan = plan_legible(read_maze(maze_file), "B", prior=np.array([0.25, 0.5, 0.25]))
        assert solved["prior"] == [0.25, 0.5, 0.25]
        assert np.array_equal(solved["r_leg"], plan.r_leg)
        assert np.array_equal(solved["policy_legible"], plan.policy_legible)

    def test_what_is_infinite_is_null(self, tmp_path, draw_maze):
        maze = draw_maze(25, 25, 3, seed=1)
        (tmp_path / "m.txt").write_text(format_maze(maze), encoding="utf-8")
        to = tmp_path / "solved.json"
        run("solve", tmp_path / "m.txt", "--goal", "A", "--gamma", "0.5", "--json", to)
        text = to.read_text(encoding="utf-8")
        solved = json.loads(text)
        assert "Infinity" not in text
        assert [s is None for s in solved["stretch"]] == [not a for a in solved["arrives"]]
        assert None in solved["stretch"]

    @pytest.mark.parametrize(
        ("options", "said"),
        [
            (["--goal", "Z"], "expected a goal of the maze (A B C), came 'Z'"),
            (["--goal", "A", "--beta", "0"], "beta above 0"),
            (["--goal", "A", "--gamma", "1"], "gamma in [0, 1)"),
            (["--goal", "A", "--formulation", "x"], "expected formulation in reward, cost"),
            (["--goal", "A", "--variant", "x"], "expected variant in"),
            (["--goal", "A", "--actions", "x"], "expected actions in udlr, udlrn"),
            (["--goal", "A", "--prior", ""], "each letter once; came '' in ''"),
            (["--goal", "A", "--prior", "A=1,B=2"], "each of the goals A B C, came A B"),
            (["--goal", "A", "--prior", "A=1,B=2,C=0"], "weight above 0 for each of 3 goals"),
            (["--goal", "A", "--json", "/none/x.json"], "No such file or directory"),
        ],
    )
    def test_bad_input_is_one_clear_line(self, maze_file, options, said):
        fails_with(said, "solve", maze_file, *options)

    def test_a_broken_maze_is_named_with_line_and_column(self, tmp_path):
        path = tmp_path / "broken.txt"
        path.write_text("+---+---+\n| A   b |\n+---+---+\n", encoding="utf-8")
        fails_with("broken.txt:2:7: expected a cell", "solve", path, "--goal", "A")

    def test_a_missing_maze_is_named(self, tmp_path):
        fails_with("none.txt", "solve", tmp_path / "none.txt", "--goal", "A")


class TestStimuli:
    def test_build_writes_the_committed_bytes_with_the_committed_seed(self, tmp_path):
        result = run("stimuli", "build", "--to", tmp_path)
        assert result.exit_code == 0
        for name in ("pool.json", "manifest.json"):
            assert (tmp_path / name).read_bytes() == (DATA / name).read_bytes()
        assert len(list(tmp_path.iterdir())) == 2

    def test_build_makes_the_folder_it_writes_to(self, tmp_path):
        assert run("stimuli", "build", "--to", tmp_path / "new" / "pool").exit_code == 0
        assert len(list((tmp_path / "new" / "pool").iterdir())) == 2

    def test_check_says_what_is_proved(self):
        result = run("stimuli", "check")
        assert result.exit_code == 0
        assert all(line.startswith("ok  ") for line in result.stdout.splitlines())
        assert len(result.stdout.splitlines()) >= 10

    def test_check_of_an_empty_folder_is_one_clear_line(self, tmp_path):
        fails_with("pool.json: expected a readable file", "stimuli", "check", tmp_path)

    def test_show_draws_one_stimulus_by_its_id(self):
        shown = POOL.stimulus("s01", "optimal")
        result = run("stimuli", "show", shown.id)
        assert result.exit_code == 0
        assert result.stdout.count("stimulus ") == 1
        assert f"s01, optimal, maze {shown.maze}, goal {shown.goal}" in result.stdout
        assert f"\n{shown.steps:>4}" in result.stdout

    @pytest.mark.parametrize(("name", "count"), [("s37", 2), ("practice", 1)])
    def test_show_draws_all_of_a_scenario(self, name, count):
        assert run("stimuli", "show", name).stdout.count("stimulus ") == count

    def test_show_of_the_unknown_says_what_there_is(self):
        fails_with("s01 to s37 or practice; came 'x'", "stimuli", "show", "x")

    def test_sheet_refuses_what_it_cannot_draw(self, tmp_path):
        fails_with("ending in .svg, .png, .pdf", "stimuli", "sheet", "--to", tmp_path / "x.doc")


@pytest.mark.parametrize(
    "command", ["solve", "stimuli build", "stimuli check", "stimuli show", "stimuli sheet"]
)
def test_every_command_has_help_with_an_example(command):
    result = run(*command.split(), "--help")
    assert result.exit_code == 0
    assert str(DATA.parent) not in result.stdout
    assert f"Example: goalguess {command}" in " ".join(result.stdout.replace("│", " ").split())


def test_runs_without_the_other_packages(maze_file):
    done = subprocess.run(
        [sys.executable, "-m", "policies", "solve", str(maze_file), "--goal", "A"],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0
    assert "legible policy to A" in done.stdout


def test_nothing_half_written_is_left_behind(tmp_path, maze_file):
    (tmp_path / "taken").mkdir()
    before = sorted(tmp_path.iterdir())
    fails_with("directory", "solve", maze_file, "--goal", "A", "--json", tmp_path / "taken")
    assert sorted(tmp_path.iterdir()) == before
