"""The level of the tests: those that know of clusters hold it, those on trials do not."""

import pytest
from typer.testing import CliRunner

from analysis.__main__ import alone
from analysis.crossed_model import Design, Spread, halves
from analysis.level_check import LevelTable, level_check
from analysis.simulated_studies import TESTS
from analysis.statistics.clustered import two_way_auc, two_way_difference

HARD = Spread(0.8, 0.5, 0.8)
NONE = Spread(0, 0, 0)


def checked(tests, spreads, studies=250, participants=150):
    return level_check(spreads, tests, halves(participants), studies, 1, 1, lambda _done: None)


def run(*arguments):
    return CliRunner(env={"COLUMNS": "200"}).invoke(alone, ["level", *arguments])


def shares(table, test):
    return [each.rejected.share for each in table.rows[test]]


@pytest.mark.parametrize(
    ("two_way", "on_trials"),
    [("two_way_difference", "chi_square"), ("two_way_auc", "mann_whitney")],
)
def test_two_way_tests_hold_their_level_where_tests_on_trials_do_not(two_way, on_trials):
    table = checked((two_way, on_trials), (NONE, HARD))
    most = 0.05 + 1.6 * table.monte_carlo_error
    assert all(each <= most for each in shares(table, two_way))
    independent, clustered = shares(table, on_trials)
    assert independent <= most
    assert clustered > 0.2


def test_the_two_way_cox_holds_its_level_where_the_one_by_participant_does_not():
    table = checked(("two_way_cox", "cox"), (NONE, HARD))
    most = 0.05 + 1.6 * table.monte_carlo_error
    assert all(each <= most for each in shares(table, "two_way_cox"))
    participants_alone, both = shares(table, "cox")
    assert participants_alone <= 0.05 + 2.5 * table.monte_carlo_error
    assert both > 0.12


def test_the_level_of_models_is_checked_too():
    table = checked(("gee_logistic", "crossed_logistic"), (HARD,), studies=2, participants=20)
    assert [each.rejected.n for row in table.rows.values() for each in row] == [2, 2]


def test_every_primary_test_of_a_plan_is_there_for_each_measure():
    for measure in ("correct", "confidence"):
        assert {two_way_difference, two_way_auc} <= set(TESTS[measure].values())


def test_of_correct_guesses_difference_and_auc_are_one_test():
    """An AUC of values 0 and 1 is .5 and half their difference."""
    tests = ("two_way_difference", "two_way_auc_of_correct", "two_way_difference_of_confidence")
    difference, auc, other = (
        shares(checked(tests, (HARD,), studies=60, participants=16), test) for test in tests
    )
    assert difference == auc
    assert difference != other


def test_arms_of_other_sizes_have_another_level_and_few_unequal_ones_too_high_a_one():
    design = Design(4, 24, trials_each=12, scenarios=200)
    tests = ("two_way_difference",)
    table = level_check((Spread(0.8, 0, 0),), tests, design, 1500, 1, 1, lambda _done: None)
    assert shares(table, "two_way_difference")[0] > 0.05 + 1.5 * table.monte_carlo_error


def test_the_monte_carlo_error_is_that_of_a_share_of_5_percent():
    assert LevelTable((), 2000, {}).monte_carlo_error == pytest.approx(0.00955, abs=1e-5)


def test_the_command_prints_a_row_a_test_and_a_column_for_each_of_the_sds():
    options = ["--sds", "0/0/0,.8/.5/.8", "--tests", "two_way_auc,chi_square"]
    result = run(*options, "--replicates", "20", "--participants", "20", "--workers", "1")
    assert result.exit_code == 0, result.stderr
    lines = result.stdout.splitlines()
    header = next(place for place, line in enumerate(lines) if line.startswith("test "))
    assert lines[header].split() == ["test", "0/0/0", "0.8/0.5/0.8"]
    assert [" ".join(line.split()[:-2]) for line in lines[header + 1 : header + 3]] == [
        "two-way AUC",
        "chi square",
    ]
    assert "10 + 10 participants with 10 trials each of 37 scenarios" in " ".join(lines)
    assert "Monte-Carlo error" in result.stdout


def test_the_rate_of_a_test_is_the_last_word_of_its_line():
    options = ["--sds", ".8/.5/.8", "--tests", "two_way_difference", "--participants", "3/5"]
    sizes = ["--trials", "7", "--scenarios", "4", "--replicates", "20", "--workers", "1"]
    result = run(*options, *sizes)
    assert result.exit_code == 0, result.stderr
    said = " ".join(result.stdout.split())
    assert "3 + 5 participants with 7 trials each of 4 scenarios" in said
    (line,) = [line for line in result.stdout.splitlines() if line.startswith("two-way")]
    assert 0 <= float(line.split()[-1]) < 0.5


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--tests", "anova"], "--tests: expected some of chi_square, gee_logistic"),
        (["--sds", "a/b/c"], "--sds: expected"),
        (["--sds", "9/0/0"], "standard deviation: expected 0 to 5"),
        (["--participants", "3"], "expected an even number of both arms together, or N/M"),
        (["--participants", "3/4/5"], "got '3/4/5'"),
        (["--participants", "0/4"], "participants in an arm: expected at least 1, got 0"),
        (["--trials", "0"], "trials per participant: expected at least 1, got 0"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(options, message):
    result = run(*options)
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in result.stderr
    assert len(result.stderr.splitlines()) == 1
