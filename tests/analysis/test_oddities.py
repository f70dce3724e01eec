"""One odd row is told, and never stops a report."""

import pytest

from analysis import PARTICIPANTS, TRIALS, TableError, analyse_path, read_dataset, write_table
from analysis.data_notices import data_notices
from analysis.reporting.plain import plain_text
from analysis.reporting.report import report_parts
from tests.analysis.rows import edited, participants_of, six_participants, trial_row

EMPTIED = "Values that cannot be are read as empty; no test takes them. Rows: "
MISSING = (
    "Times of a page are empty although a later one was finished, as where the server's clock was "
    "set back; no test takes them. Rows: "
)


def told(folder, plan=None):
    """What is told of the data in a folder, as a mapping from code to text."""
    return {each.code: each.text for each in data_notices(read_dataset(folder, plan))}


@pytest.fixture
def study_of_150(tmp_path):
    """An export of 150 participants with three trials each."""
    rows = [
        trial_row(f"P{number}", index, ("polmdp", "optimal")[number % 2], stop_time_s=5.0 + index)
        for number in range(150)
        for index in (1, 2, 3)
    ]
    write_table(TRIALS, rows, tmp_path)
    write_table(PARTICIPANTS, participants_of(rows), tmp_path)
    return tmp_path


def test_a_negative_time_of_an_older_export_is_told_and_the_rest_analysed(study_of_150):
    edited(study_of_150 / "participants.csv", 77, "about_you_s", "-3540.0")
    results = analyse_path(study_of_150)
    assert len(results.data.trials) == 450
    said = f"{EMPTIED}about_you_s in 1 of participants.csv."
    assert said in " ".join(plain_text(report_parts(results)).split())


def test_a_time_that_the_export_left_empty_is_told_and_the_rest_analysed(study_of_150):
    edited(study_of_150 / "participants.csv", 77, "about_you_s", "")
    results = analyse_path(study_of_150)
    assert len(results.data.trials) == 450
    said = f"{MISSING}about_you_s in 1 of participants.csv."
    assert said in " ".join(plain_text(report_parts(results)).split())


def test_an_export_without_odd_rows_is_told_nothing_of_them(study_of_150):
    assert not {"values_emptied", "times_missing", "impossible_time"} & set(told(study_of_150))


@pytest.mark.parametrize(
    ("column", "odd"),
    [
        ("too_fast_trials", -1),
        ("pauses", -1),
        ("practice_s", -0.001),
        ("pointer_type", "trackball"),
    ],
)
def test_a_description_that_cannot_be_is_read_as_empty(export, column, odd):
    people = participants_of(six_participants())
    people[1][column] = odd
    write_table(PARTICIPANTS, people, export)
    read = read_dataset(export).participants
    assert read is not None
    assert read[column].null_count() == 1
    assert told(export)["values_emptied"] == f"{EMPTIED}{column} in 1 of participants.csv."


def test_odd_values_of_both_tables_are_counted_by_column(export):
    for row in (2, 3):
        edited(export / "participants.csv", row, "trials_s", "-1")
    edited(export / "trials.csv", 4, "server_stretch_s", "-0.25")
    edited(export / "trials.csv", 5, "first_decision_s", "-2")
    assert told(export)["values_emptied"] == (
        f"{EMPTIED}first_decision_s in 1 of trials.csv, server_stretch_s in 1 of trials.csv, "
        "trials_s in 2 of participants.csv."
    )


@pytest.mark.parametrize(
    ("empty", "said"),
    [
        (("about_you_s", "practice_s"), "about_you_s in 1 of participants.csv, practice_s in 1"),
        (("trials_s",), "trials_s in 1"),
        (("practice_s", "trials_s"), "practice_s in 1 of participants.csv, trials_s in 1"),
    ],
)
def test_whoever_came_further_lacks_the_times_before(export, empty, said):
    for column in empty:
        edited(export / "participants.csv", 3, column, "")
    assert told(export)["times_missing"] == f"{MISSING}{said} of participants.csv."


def test_whoever_is_still_on_the_way_lacks_no_times(export):
    edited(export / "participants.csv", 3, "status", "trials")
    edited(export / "participants.csv", 3, "trials_s", "")
    assert "times_missing" not in told(export)


@pytest.mark.parametrize(("column", "text"), [("stop_time_s", "-1"), ("confidence", "8")])
def test_what_the_tests_take_is_still_refused(export, column, text):
    edited(export / "trials.csv", 3, column, text)
    with pytest.raises(TableError, match=f"row 3, column {column}"):
        read_dataset(export)


IMPOSSIBLE = '[[exclusions]]\nrule = "impossible_time"'


def test_times_that_cannot_be_are_counted_and_left_out_only_by_a_plan(export, plan_of):
    for row in (2, 3, 5):  # two trials of the first participant, one of the second
        edited(export / "trials.csv", row, "impossible_time", "true")
    for row in (2, 3, 4):  # the third has it by all trials together
        edited(export / "participants.csv", row, "impossible_time", "true")
    data = read_dataset(export)
    assert len(data.trials) == 18
    text = told(export)["impossible_time"]
    assert text.startswith("Times that cannot be: 3 of the participants analysed and 3 of the ")
    assert text.endswith("the rule impossible_time of a plan leaves such participants out.")
    edited(export / "participants.csv", 4, "impossible_time", "")
    kept = read_dataset(export, plan_of(IMPOSSIBLE))
    assert kept.excluded[0].participants == ("P1", "P2")
    assert "impossible_time" not in told(export, plan_of(IMPOSSIBLE))


def test_a_file_of_trials_alone_tells_of_them_too(export):
    edited(export / "trials.csv", 2, "impossible_time", "true")
    text = told(export / "trials.csv")["impossible_time"]
    assert "1 of the participants analysed and 1 of the trials" in text


def test_a_plan_with_the_rule_is_followed_where_nobody_could_be_judged(export, plan_of):
    for row in range(2, 8):
        edited(export / "participants.csv", row, "impossible_time", "")
    assert read_dataset(export, plan_of(IMPOSSIBLE)).excluded[0].participants == ()
