"""The command `analyse`: what it prints, what it writes, how it fails."""

import subprocess
import sys
import time

import pytest
import typer
from typer.testing import CliRunner

from analysis import TRIALS, commands, write_table
from analysis.__main__ import alone
from tests.analysis.rows import edited, six_participants

run = CliRunner().invoke


def python_m(*arguments):
    return subprocess.run(
        [sys.executable, "-W", "error", "-m", "analysis", *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
    )


def test_it_prints_the_papers_numbers(paper_fixture):
    result = python_m("analyse", paper_fixture)
    assert result.returncode == 0
    for said in ("chi2(1) = 48.864", "U = 177976", "U = 231203", "15.67", "18.22", "6.08", "5.78"):
        assert said in result.stdout
    assert result.stderr.startswith("Add --to DIR")


def test_1500_trials_take_under_three_seconds_of_computing(paper_fixture):
    run(alone, ["analyse", str(paper_fixture)])
    start = time.process_time()
    run(alone, ["analyse", str(paper_fixture)])
    assert time.process_time() - start < 3


def test_it_writes_the_report_and_the_figures(export, tmp_path):
    result = run(alone, ["analyse", str(export), "--to", str(tmp_path / "new" / "report")])
    assert result.exit_code == 0
    names = {path.name for path in (tmp_path / "new" / "report").iterdir()}
    assert names == {"report.html", "report.json", "report.md", "apa.txt", "figures"}
    assert list((tmp_path / "new").iterdir()) == [tmp_path / "new" / "report"]


def test_it_follows_the_plan_and_the_mapping_it_is_given(paper_fixture, tmp_path):
    (tmp_path / "plan.toml").write_text('[treatment]\ncondition = "polmdp"\nlabel = "legible"\n')
    (tmp_path / "mapping.toml").write_text('[columns]\nscenario = "video"\n')
    options = ["--plan", tmp_path / "plan.toml", "--mapping", tmp_path / "mapping.toml"]
    result = run(alone, ["analyse", str(paper_fixture), *map(str, options)])
    assert result.exit_code == 0
    assert "H1, correct guesses: more with legible." in result.stdout


def test_a_plan_that_cannot_be_followed_ends_with_code_2_and_one_line(paper_fixture, tmp_path):
    (tmp_path / "plan.toml").write_text("alpha = 2\n")
    result = run(alone, ["analyse", str(paper_fixture), "--plan", str(tmp_path / "plan.toml")])
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith("goalguess: plan.toml, key alpha: expected")


def test_without_to_it_writes_nothing(export, tmp_path):
    before = sorted(tmp_path.rglob("*"))
    assert run(alone, ["analyse", str(export)]).exit_code == 0
    assert sorted(tmp_path.rglob("*")) == before


def test_simulated_participants_come_in_with_the_flag_only(tmp_path):
    rows = [row | {"simulated": True} for row in six_participants()]
    path = str(write_table(TRIALS, rows, tmp_path)[0])
    refused = run(alone, ["analyse", path])
    assert (refused.exit_code, refused.stdout) == (2, "")
    assert "simulated or preview trials left out" in refused.stderr
    asked = run(alone, ["analyse", path, "--simulated"])
    assert asked.exit_code == 0
    assert "Not a result" in asked.stdout


def test_bad_input_ends_with_code_2_and_one_line(export, tmp_path):
    edited(export / "trials.csv", 7, "confidence", "9")
    result = python_m("analyse", export, "--to", tmp_path / "report")
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr == (
        "goalguess: trials.csv, row 7, column confidence: "
        "expected whole number from 1 to 7, got 9\n"
    )
    assert not (tmp_path / "report").exists()


@pytest.mark.parametrize("name", ["nothing", "image.png", "trials.csv"])
def test_anything_that_is_no_study_ends_with_code_2_and_one_line(tmp_path, name):
    (tmp_path / "image.png").write_bytes(b"\x89PNG")
    (tmp_path / "trials.csv").write_bytes(b"\x89PNG\r\n\x1a\n\x00\x00\xff")
    result = run(alone, ["analyse", str(tmp_path / name)])
    assert result.exit_code == 2
    assert len(result.stderr.splitlines()) == 1


def test_a_folder_that_cannot_be_written_ends_with_code_2_and_one_line(export, tmp_path):
    (tmp_path / "taken").write_text("")
    result = run(alone, ["analyse", str(export), "--to", str(tmp_path / "taken")])
    assert (result.exit_code, result.stdout) == (2, "")
    assert "expected a folder to write to" in result.stderr


def test_help_shows_an_example():
    result = run(alone, ["analyse", "--help"])
    assert "goalguess analyse export/ --to report/" in " ".join(result.stdout.split())


def test_help_loads_no_heavy_library():
    code = (
        "import sys; from typer.testing import CliRunner; from analysis.__main__ import alone;"
        "assert CliRunner().invoke(alone, ['analyse', '--help']).exit_code == 0;"
        "print(sorted({'polars', 'numpy', 'scipy', 'matplotlib'} & set(sys.modules)))"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert result.stdout == "[]\n"


def test_another_command_line_can_take_the_command_in(export):
    larger = typer.Typer()
    larger.command("other")(lambda: None)
    larger.add_typer(commands)
    result = run(larger, ["analyse", str(export)])
    assert result.exit_code == 0
    assert "chi2(1)" in result.stdout
