"""The contract of the export: declared once, complete, and cheap to import."""

import subprocess
import sys

import polars as pl
import pytest

import analysis
from analysis import EVENTS, PARTICIPANTS, TABLES, TRIALS, Kind, code_book
from analysis.columns import Column

ALL_COLUMNS = [(table, column) for table in TABLES for column in table.columns]


def loaded_by(statement: str) -> set[str]:
    code = f"import sys; {statement}; print('\\n'.join(sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(run.stdout.split())


def test_the_trials_table_has_the_columns_that_were_agreed():
    agreed = """
        participant condition scenario stimulus maze trial_index goal guess correct
        stop_time_s length_s prediction_time_s score confidence reached_end steps_seen
        started_at stopped_at answered_at guess_latency_s confidence_latency_s lead_in_s
        pauses paused_s focus_losses reduced_motion frames_dropped pointer_moved
        first_decision_s too_fast press_s last_frame_s frame_interval_s played_waited_s
        stopped_waited_s server_stretch_s impossible_time times_clamped watched_elsewhere
        simulated preview study_hash app_version
    """
    assert list(TRIALS.names) == agreed.split()


def test_column_names_are_used_once_in_a_table():
    for table in TABLES:
        assert len(set(table.names)) == len(table.names)


def test_what_makes_a_row_unique_is_never_empty():
    for table in TABLES:
        assert all(not table.column(name).nullable for name in table.key)


@pytest.mark.parametrize(
    ("table", "column"), ALL_COLUMNS, ids=[f"{t.name}.{c.name}" for t, c in ALL_COLUMNS]
)
def test_the_code_book_explains_every_column(table, column):
    section = code_book().split(f"## {table.name}\n")[1].split("\n## ")[0]
    row = next(line for line in section.splitlines() if line.startswith(f"| `{column.name}` |"))
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    may_be_empty = "yes" if column.nullable else "no"
    assert cells[1:] == [column.meaning, column.kind, column.unit, column.allowed, may_be_empty]
    assert column.meaning.endswith((".", "..."))


def test_durations_and_sizes_carry_their_unit():
    units = {"_s": "s", "_ms": "ms", "_hz": "Hz"}
    for _, column in ALL_COLUMNS:
        for ending, unit in units.items():
            if column.name.endswith(ending) and column.kind is Kind.NUMBER:
                assert column.unit == unit


def test_no_recruiters_id_is_in_the_export():
    names = {column.name for _, column in ALL_COLUMNS}
    assert not {name for name in names if "prolific" in name or "pid" in name}


def test_times_are_in_utc_with_microseconds():
    assert TRIALS.schema["started_at"] == pl.Datetime("us", "UTC")
    assert PARTICIPANTS.schema["dealt_at"] == pl.Datetime("us", "UTC")
    assert EVENTS.schema["server_time"] == pl.Datetime("us", "UTC")


def test_schemas_follow_the_order_of_the_columns():
    for table in TABLES:
        assert tuple(table.schema) == table.names


def test_asking_for_an_unknown_column_fails():
    with pytest.raises(KeyError):
        TRIALS.column("mood")


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        ({"low": 1, "high": 7}, "from 1 to 7"),
        ({"low": 0}, "0 or more"),
        ({"above": 0}, "above 0"),
        ({"choices": ("a", "b")}, "a or b"),
        ({"letter": True}, "one letter A-Z"),
        ({}, ""),
    ],
)
def test_limits_are_told_in_words(limits, words):
    assert Column("x", Kind.NUMBER, "Meaning.", **limits).allowed == words


def test_importing_the_package_loads_no_heavy_library():
    loaded = loaded_by("import analysis; from analysis import score, TRIALS, code_book, commands")
    assert not loaded & {"polars", "numpy", "scipy", "matplotlib"}


def test_the_measures_load_alone():
    loaded = loaded_by("from analysis import correct, prediction_time_s, score")
    ours = {name for name in loaded if name.startswith("analysis.")}
    assert ours == {"analysis.measures"}


def test_every_public_name_can_be_had():
    for name in dir(analysis):
        assert getattr(analysis, name) is not None
