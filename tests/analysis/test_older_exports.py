"""Exports made before columns were added are analysed as fully as on the day they were made."""

import shutil
from pathlib import Path

import polars as pl
import pytest

from analysis import (
    PARTICIPANTS,
    TRIALS,
    TableError,
    TomlError,
    analyse_path,
    read_dataset,
    read_table,
    write_table,
)
from analysis.reporting.as_json import as_json
from tests.analysis.rows import edited

ADDED = {
    "trials": [
        "pointer_moved",
        "first_decision_s",
        "too_fast",
        "press_s",
        "last_frame_s",
        "frame_interval_s",
        "server_stretch_s",
        "impossible_time",
        "times_clamped",
        "watched_elsewhere",
    ],
    "participants": [
        "never_moved_pointer",
        "same_guess",
        "same_confidence",
        "too_fast_trials",
        "pauses",
        "focus_losses",
        "frames_dropped",
        "about_you_s",
        "instructions_s",
        "practice_s",
        "trials_s",
        "recruited",
        "pilot_before",
        "impossible_time",
    ],
}


def without(file, columns):
    """Write a file of the export again without some of its columns."""
    path = Path(file)
    if path.suffix == ".csv":
        pl.read_csv(path, infer_schema=False).drop(columns).write_csv(path)
    elif path.suffix == ".parquet":
        pl.read_parquet(path).drop(columns).write_parquet(path)
    else:
        pl.read_ndjson(path).drop(columns).write_ndjson(path)


@pytest.fixture(params=[".csv", ".parquet", ".jsonl"])
def older(request, export, tmp_path):
    """The same six participants, exported in one format before the columns were added."""
    folder = tmp_path / "older"
    folder.mkdir()
    for name, columns in ADDED.items():
        without(shutil.copy(export / f"{name}{request.param}", folder), columns)
    return folder


def numbers(folder):
    report = as_json(analyse_path(folder))
    return report["as_in_paper"], report["warnings"], report["selection"]


def test_the_report_is_the_same_with_its_demographics(older, export):
    assert numbers(older) == numbers(export)


def test_what_was_not_recorded_is_read_as_empty(older):
    people = read_dataset(older).participants
    assert people is not None
    assert dict(people.schema) == PARTICIPANTS.schema
    assert people.select(ADDED["participants"]).null_count().row(0) == (6,) * 14


def test_a_single_table_is_read_with_its_schema(older):
    (path,) = older.glob("trials.*")
    frame = read_table(TRIALS, path)
    assert dict(frame.schema) == TRIALS.schema
    assert len(frame) == 18


def test_a_rule_of_the_plan_about_what_was_not_recorded_is_one_clear_error(older, plan_of):
    plan = plan_of('[[exclusions]]\nrule = "impossible_time"')
    with pytest.raises(TomlError, match="the column impossible_time in the table participants"):
        read_dataset(older, plan)


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_an_empty_table_is_read_with_its_schema(tmp_path, suffix):
    write_table(PARTICIPANTS, [], tmp_path)
    path = tmp_path / f"participants{suffix}"
    without(path, ADDED["participants"])
    frame = read_table(PARTICIPANTS, path)
    assert (dict(frame.schema), len(frame)) == (PARTICIPANTS.schema, 0)


def test_it_is_held_to_the_contract_it_was_made_under(export):
    for name, columns in ADDED.items():
        without(export / f"{name}.csv", columns)
    edited(export / "trials.csv", 9, "guess", "")
    with pytest.raises(TableError, match=r"trials\.csv, row 9, column guess: .* got nothing"):
        read_dataset(export)


@pytest.mark.parametrize("column", ["age", "status", "trials_answered"])
def test_a_column_that_every_version_wrote_is_asked_for(export, column):
    without(export / "participants.csv", [*ADDED["participants"], column])
    with pytest.raises(TableError, match=f"expected column {column}, got"):
        read_dataset(export)
