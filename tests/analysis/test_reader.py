"""Reading a study: what is accepted, what is left out, and which row an error names."""

import hashlib
import math

import polars as pl
import pytest

from analysis import (
    PARTICIPANTS,
    TRIALS,
    AnalysisError,
    EmptyArmError,
    TableError,
    derive,
    read_dataset,
    write_table,
)
from analysis.trial_rules import trial_problems
from analysis.validation import ROW
from tests.analysis.rows import (
    as_csv,
    edited,
    participant_row,
    participants_of,
    six_participants,
    trial_row,
)


def foreign_rows():
    """Trials under other names, as another lab may have them."""
    return [
        {
            "participant": f"P{number}",
            "condition": "polmdp" if number % 2 else "optimal",
            "video": "V1",
            "trial": trial,
            "correct": 1,
            "stop_time": 4.0 + trial,
            "video_length": 20.0,
            "confidence": 5,
        }
        for number in (1, 2)
        for trial in (1, 2)
    ]


def people_of(data):
    assert data.participants is not None
    return data.participants


def complaint(path, **options):
    with pytest.raises(TableError) as caught:
        read_dataset(path, **options)
    return caught.value


def test_an_export_folder_gives_trials_and_participants(export):
    data = read_dataset(export)
    assert (len(data.trials), len(people_of(data))) == (18, 6)
    assert [source.file for source in data.sources] == ["trials.csv", "participants.csv"]
    assert data.renamed == ()


def test_the_hash_is_that_of_the_file(export):
    digest = hashlib.sha256((export / "trials.csv").read_bytes()).hexdigest()
    assert read_dataset(export).sources[0].sha256 == digest


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".jsonl"])
def test_every_format_gives_the_same_trials(export, suffix):
    expected = read_dataset(export / "trials.csv").trials
    alone = read_dataset(export / f"trials{suffix}")
    assert alone.trials.equals(expected)
    assert alone.participants is None


def test_a_folder_with_parquet_only_is_read(export):
    for path in export.iterdir():
        if path.suffix != ".parquet":
            path.unlink()
    assert len(read_dataset(export).trials) == 18


def test_a_folder_without_trials_is_one_clear_error(tmp_path):
    with pytest.raises(AnalysisError, match=r"expected a folder with trials.csv or trials.parquet"):
        read_dataset(tmp_path)


def test_a_path_with_nothing_there_is_one_clear_error(tmp_path):
    with pytest.raises(AnalysisError, match="expected an export folder or a file of trials"):
        read_dataset(tmp_path / "nothing")


def test_simulated_and_preview_trials_are_left_out_and_counted(tmp_path):
    rows = six_participants()
    rows += [trial_row("bot", index, "polmdp", simulated=True) for index in (1, 2)]
    rows += [trial_row("me", 1, "optimal", preview=True)]
    path = write_table(TRIALS, rows, tmp_path)[0]
    data = read_dataset(path)
    assert (len(data.trials), data.simulated, data.preview) == (18, 2, 1)
    assert not {"bot", "me"} & set(data.trials["participant"])


def test_simulated_and_preview_participants_come_in_when_asked_for(tmp_path):
    rows = six_participants()
    rows += [
        trial_row("bot", 1, "polmdp", simulated=True),
        trial_row("me", 1, "optimal", preview=True),
    ]
    write_table(TRIALS, rows, tmp_path)
    people = participants_of(rows)
    people[-2] |= {"simulated": True}
    people[-1] |= {"preview": True}
    write_table(PARTICIPANTS, people, tmp_path)
    assert len(people_of(read_dataset(tmp_path))) == 6
    data = read_dataset(tmp_path, with_simulated=True)
    assert (len(data.trials), len(people_of(data))) == (20, 8)


def test_a_study_of_simulated_participants_only_says_what_was_left_out(tmp_path):
    rows = [row | {"simulated": True} for row in six_participants()]
    path = write_table(TRIALS, rows, tmp_path)[0]
    with pytest.raises(EmptyArmError, match=r"got none \(18 simulated or preview trials left out"):
        read_dataset(path)
    assert len(read_dataset(path, with_simulated=True).trials) == 18


def test_an_arm_without_trials_is_named(tmp_path):
    rows = [row for row in six_participants() if row["condition"] == "polmdp"]
    with pytest.raises(
        EmptyArmError, match=r"trials.csv, condition optimal: expected at least one trial"
    ):
        read_dataset(write_table(TRIALS, rows, tmp_path)[0])


def test_an_export_without_any_row_is_one_clear_error(tmp_path):
    for path in write_table(TRIALS, [], tmp_path):
        with pytest.raises(AnalysisError) as caught:
            read_dataset(path)
        assert str(caught.value).startswith(f"{path.name}: expected at least one trial, got ")


@pytest.mark.parametrize(("separator", "called"), [(";", "semicolons"), ("\t", "tabs")])
def test_a_table_with_another_separator_is_told_that_commas_are_expected(
    tmp_path, separator, called
):
    path = as_csv(tmp_path / "t.csv", foreign_rows())
    path.write_text(path.read_text().replace(",", separator))
    error = complaint(path)
    assert error.row == 1
    assert f"names separated by commas, got them separated by {called}" in str(error)


@pytest.mark.parametrize("row", [1, 3, 20_000])
@pytest.mark.parametrize("suffix", [".csv", ".jsonl"])
def test_a_character_that_is_not_utf_8_is_named_by_its_row_and_byte(tmp_path, suffix, row):
    path = tmp_path / f"t{suffix}"
    frame = pl.DataFrame([foreign_rows()[0] | {"video": "cafe"}] * 20_000)
    frame.write_csv(path) if suffix == ".csv" else frame.write_ndjson(path)
    lines = path.read_bytes().splitlines(keepends=True)
    lines[row - 1] = lines[row - 1].replace(b"e", b"\xe9", 1)
    path.write_bytes(b"".join(lines))
    error = complaint(path)
    assert error.row == row
    assert str(error).endswith("characters in UTF-8, got byte 0xe9; save the table as UTF-8")


def test_a_cell_too_long_for_any_table_is_one_clear_error(tmp_path):
    (tmp_path / "t.csv").write_text('"' + "a" * 200_000)
    assert complaint(tmp_path / "t.csv").file == "t.csv"


def test_empty_rows_are_passed_over_but_counted(tmp_path):
    path = as_csv(tmp_path / "t.csv", foreign_rows())
    lines = path.read_text().splitlines()
    path.write_text("\n".join([lines[0], ",,,,,,,", *lines[1:], "", ""]))
    assert len(read_dataset(path).trials) == 4
    edited(path, 3, "confidence", "8")
    assert complaint(path).row == 3


@pytest.mark.parametrize(
    ("row", "column", "text", "words"),
    [
        (5, "condition", "legible", "expected polmdp or optimal, got 'legible'"),
        (2, "confidence", "8", "expected whole number from 1 to 7, got 8"),
        (2, "confidence", "0", "expected whole number from 1 to 7, got 0"),
        (2, "confidence", "6.5", "expected whole number from 1 to 7, got '6.5'"),
        (2, "confidence", "high", "expected whole number from 1 to 7, got 'high'"),
        (9, "guess", "", "expected one letter A-Z, got nothing"),
        (9, "guess", "b", "expected one letter A-Z, got 'b'"),
        (9, "goal", "BB", "expected one letter A-Z, got 'BB'"),
        (4, "stop_time_s", "-0.1", "expected number 0 or more, got -0.1"),
        (4, "stop_time_s", "inf", "expected number 0 or more, got 'inf'"),
        (4, "length_s", "0", "expected number above 0, got 0.0"),
        (4, "stop_time_s", "20.5", "no later than length_s, got stop_time_s 20.5, length_s 20.0"),
        (3, "correct", "false", "the same, got correct false, guess 'B', goal 'B'"),
        (3, "correct", "maybe", "expected true or false, got 'maybe'"),
        (3, "prediction_time_s", "20.0", "that its definition gives, got prediction_time_s 20.0"),
        (3, "score", "9.9", "that its definition gives, got score 9.9"),
        (3, "reached_end", "true", "stop_time_s equal to length_s where the end was reached"),
        (5, "too_fast", "true", "true if and only if stop_time_s is less than first_decision_s"),
        (5, "first_decision_s", "20.5", "a decision no later than length_s"),
        (5, "first_decision_s", "", "expected number 0 or more, got nothing"),
        (5, "pointer_moved", "perhaps", "expected true or false, got 'perhaps'"),
        (3, "trial_index", "1", "each participant and trial_index once, got participant 'P1'"),
        (3, "trial_index", "0", "expected whole number 1 or more, got 0"),
        (4, "condition", "optimal", "one condition per participant, got participant 'P1'"),
        (2, "scenario", "", "expected text, got nothing"),
        (2, "started_at", "noon", "expected UTC time, got 'noon'"),
        (2, "simulated", "", "expected true or false, got nothing"),
    ],
)
def test_a_broken_rule_of_the_trials_is_named_by_row_and_column(export, row, column, text, words):
    edited(export / "trials.csv", row, column, text)
    error = complaint(export / "trials.csv")
    assert (error.file, error.row, error.column) == ("trials.csv", row, column)
    assert words in str(error)


@pytest.mark.parametrize("number", [math.inf, math.nan])
def test_a_number_of_parquet_that_is_none_is_named(export, number):
    frame = pl.read_parquet(export / "trials.parquet")
    times = frame["guess_latency_s"].to_list()
    times[2] = number
    frame.with_columns(guess_latency_s=pl.Series(times)).write_parquet(export / "trials.parquet")
    error = complaint(export / "trials.parquet")
    assert (error.row, error.column) == (4, "guess_latency_s")


def test_rules_bind_simulated_rows_too_because_the_file_is_one(export):
    edited(export / "trials.csv", 6, "simulated", "true")
    edited(export / "trials.csv", 6, "confidence", "9")
    assert complaint(export / "trials.csv").row == 6


def test_a_trial_of_someone_not_among_the_participants_is_named(tmp_path):
    rows = six_participants()
    write_table(TRIALS, rows, tmp_path)
    write_table(PARTICIPANTS, participants_of(rows)[:-1], tmp_path)
    error = complaint(tmp_path)
    assert (error.row, error.column, error.further) == (17, "participant", 2)
    assert "participants.csv" in str(error)


@pytest.mark.parametrize(
    "other", [{"condition": "optimal"}, {"simulated": True}, {"preview": True}]
)
def test_a_trial_marked_otherwise_than_its_participant_is_named(tmp_path, other):
    rows = six_participants()
    people = participants_of(rows)
    people[1] |= other
    write_table(TRIALS, rows, tmp_path)
    write_table(PARTICIPANTS, people, tmp_path)
    error = complaint(tmp_path)
    assert (error.row, error.column) == (5, next(iter(other)))


def test_a_broken_participant_is_named(export):
    edited(export / "participants.csv", 4, "age", "young")
    error = complaint(export)
    assert (error.file, error.row, error.column) == ("participants.csv", 4, "age")


def test_other_column_names_are_understood_and_told(tmp_path):
    data = read_dataset(as_csv(tmp_path / "t.csv", foreign_rows()))
    assert dict(data.renamed) == {
        "video": "scenario",
        "trial": "trial_index",
        "stop_time": "stop_time_s",
        "video_length": "length_s",
    }
    assert data.trials["prediction_time_s"].to_list() == [5.0, 6.0, 5.0, 6.0]


def test_an_error_names_the_column_as_the_file_does(tmp_path):
    path = as_csv(tmp_path / "t.csv", foreign_rows())
    edited(path, 3, "stop_time", "21")
    error = complaint(path)
    assert (error.row, error.column) == (3, "stop_time")


def test_both_names_of_one_column_are_refused(tmp_path):
    rows = [row | {"scenario": "S"} for row in foreign_rows()]
    assert "video or scenario, got both" in str(complaint(as_csv(tmp_path / "t.csv", rows)))


@pytest.mark.parametrize("column", ["participant", "condition", "video", "trial", "confidence"])
def test_a_needed_column_that_is_missing_is_named(tmp_path, column):
    rows = [{name: cell for name, cell in row.items() if name != column} for row in foreign_rows()]
    error = complaint(as_csv(tmp_path / "t.csv", rows))
    named = {"video": "scenario", "trial": "trial_index"}.get(column, column)
    assert error.row == 1
    assert f"expected column {named}, got " in str(error)


def test_several_missing_columns_are_named_together(tmp_path):
    rows = [{"participant": "P1", "condition": "optimal", "correct": 1}]
    error = complaint(as_csv(tmp_path / "t.csv", rows))
    assert "expected columns scenario, trial_index, " in str(error)


def test_without_correct_it_takes_guess_and_goal(tmp_path):
    rows = [
        {name: cell for name, cell in row.items() if name != "correct"}
        | {"guess": "A", "goal": "A" if row["trial"] == 1 else "B"}
        for row in foreign_rows()
    ]
    data = read_dataset(as_csv(tmp_path / "t.csv", rows))
    assert data.trials["correct"].to_list() == [True, False, True, False]
    assert data.trials["prediction_time_s"].to_list() == [5.0, 20.0, 5.0, 20.0]


def test_without_correct_or_guess_and_goal_nothing_can_be_analysed(tmp_path):
    rows = [
        {name: cell for name, cell in row.items() if name != "correct"} for row in foreign_rows()
    ]
    assert "correct (or guess and goal)" in str(complaint(as_csv(tmp_path / "t.csv", rows)))


@pytest.mark.parametrize("mark", [None, "NA"])
def test_answers_missing_in_a_table_from_elsewhere_stay_missing(tmp_path, mark):
    rows = foreign_rows()
    rows[0]["correct"] = mark
    rows[3]["confidence"] = mark
    trials = read_dataset(as_csv(tmp_path / "t.csv", rows)).trials
    assert trials["correct"].to_list() == [None, True, True, True]
    assert trials["prediction_time_s"].to_list() == [None, 6.0, 5.0, 6.0]
    assert trials["confidence"].to_list() == [5, 5, 5, None]


@pytest.mark.parametrize("column", ["participant", "condition", "video", "trial"])
def test_what_tells_a_trial_apart_is_never_missing(tmp_path, column):
    rows = foreign_rows()
    rows[1][column] = None
    error = complaint(as_csv(tmp_path / "t.csv", rows))
    assert (error.row, error.column) == (3, column)


def test_the_order_of_rows_in_the_files_changes_nothing(export, tmp_path):
    for name in ("trials.csv", "participants.csv"):
        frame = pl.read_csv(export / name, infer_schema=False)
        (tmp_path / "shuffled").mkdir(exist_ok=True)
        frame.sample(fraction=1, shuffle=True, seed=3).write_csv(tmp_path / "shuffled" / name)
    shuffled, whole = read_dataset(tmp_path / "shuffled"), read_dataset(export)
    assert shuffled.trials.equals(whole.trials)
    assert people_of(shuffled).equals(people_of(whole))


def test_a_wrong_guess_takes_the_full_length_even_if_its_stop_is_not_known(tmp_path):
    rows = foreign_rows()
    for row, right in zip(rows, (0, 1, 0, 1), strict=True):
        row["correct"] = right
        row["stop_time"] = None
    trials = read_dataset(as_csv(tmp_path / "t.csv", rows)).trials
    assert trials["prediction_time_s"].to_list() == [20.0, None, 20.0, None]


def test_golden_penalised_time(golden):
    case = golden("penalised_time")
    given = case["input"]["trials"]
    trials = pl.DataFrame(
        {
            ROW: range(len(given["correct"])),
            "participant": ["a", "b", "c", "d"],
            "condition": "polmdp",
            "correct": pl.Series(given["correct"], dtype=pl.Int8).cast(pl.Boolean),
            "stop_time_s": pl.Series(given["stop_time"], dtype=pl.Float64),
            "length_s": pl.Series(given["video_length"], dtype=pl.Float64),
        }
    )
    times = trials.select(derive.PREDICTION_TIME_S).to_series()
    assert times.to_list() == case["expected"]["time"]
    found = [{"row": row, "code": p.code} for p in trial_problems(trials) for row in p.rows]
    assert found == case["expected"]["row_errors"]


def test_a_participant_without_trials_is_no_problem(tmp_path):
    rows = six_participants()
    write_table(TRIALS, rows, tmp_path)
    write_table(PARTICIPANTS, [*participants_of(rows), participant_row("P9", None)], tmp_path)
    assert len(people_of(read_dataset(tmp_path))) == 7
