import pytest
from typer.testing import CliRunner

from policies import commands, format_maze

ENDS = {".csv", ".json", "-ratios.csv", "-differences.csv", ".svg", ".png"}
FEW = {"sequences": ("--starts", "2"), "samples": ("--sets", "3")}


def run(*arguments):
    return CliRunner().invoke(commands, ["teach", *(str(each) for each in arguments)])


@pytest.fixture
def mazes(tmp_path, draw_maze):
    """A folder with one small maze."""
    folder = tmp_path / "mazes"
    folder.mkdir()
    (folder / "small.txt").write_text(format_maze(draw_maze(3, 4, 2, seed=1)), encoding="utf-8")
    return folder


def files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.parametrize("predictor", ["bayes", "gradient"])
@pytest.mark.parametrize("lessons", ["sequences", "samples"])
def test_a_run_leaves_rows_tables_and_figure_and_prints_the_ratios(
    mazes, tmp_path, lessons, predictor
):
    given = (lessons, *FEW[lessons], "--mazes", mazes, "--predictor", predictor, "--workers", 1)
    result = run(*given, "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert set(files(tmp_path / "out")) == {f"{lessons}-{predictor}{end}" for end in ENDS}
    assert result.stdout.startswith("| k | PoLMDP")
    assert result.stdout.count("\n") == 6


def test_a_second_run_is_refused_in_one_line_and_resumed_by_option(mazes, tmp_path):
    given = ("samples", "--sets", 3, "--mazes", mazes, "--out", tmp_path / "out")
    assert run(*given).exit_code == 0
    first = files(tmp_path / "out")
    refused = run(*given)
    assert refused.exit_code == 2
    assert refused.stderr.count("\n") == 1
    assert "expected no results here" in refused.stderr
    assert run(*given, "--resume").exit_code == 0
    assert files(tmp_path / "out") == first


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--mazes", "no-such-folder"], "no-such-folder: expected a folder with maze files"),
        (["--sets", "1"], "expected at least 2 units for an interval, came 1"),
        (["--predictor", "x"], "expected predictor in bayes, gradient; came 'x'"),
        (["--eta", "0"], "expected a finite eta above 0, came 0"),
    ],
)
def test_bad_input_is_one_clear_line_and_leaves_nothing(tmp_path, options, said):
    result = run("samples", *options, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert said in result.stderr
    assert result.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_lessons_of_an_unknown_kind_are_refused(tmp_path):
    result = run("songs", "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert "expected lessons in sequences, samples; came 'songs'" in result.stderr


def test_help_has_an_example():
    text = " ".join(run("--help").stdout.replace("│", " ").split())
    assert "Example: goalguess teach samples" in text
