"""The export: what was recorded, derived once, readable by the analysis."""

import json
import sqlite3

import polars as pl
import pytest

from analysis import EVENTS, PARTICIPANTS, TRIALS, read_table
from app.export import export
from app.tables import places, trials


@pytest.fixture
def write(client, study, tmp_path):
    def run(simulated=False):
        done = export(client.app.state.services.database, study, tmp_path / "out", simulated)
        return done.rows, tmp_path / "out"

    return run


def test_a_row_per_answered_trial_a_row_per_participant_and_the_log(
    browser, another_browser, write
):
    browser.take_part()
    begun = another_browser()
    begun.reach_trials()
    begun.play(1)
    counts, _ = write()
    assert (counts["trials"], counts["participants"]) == (10, 2)
    assert counts["events"] > 30


def test_every_table_is_written_in_three_forms_with_its_code_book(browser, write):
    browser.take_part()
    _, folder = write()
    names = {file.name for file in folder.iterdir()}
    wanted = {
        f"{t}.{f}"
        for t in ("trials", "participants", "events")
        for f in ("csv", "jsonl", "parquet")
    }
    assert names == wanted | {"codebook.md", "study.json"}
    book = (folder / "codebook.md").read_text()
    for table in (TRIALS, PARTICIPANTS, EVENTS):
        assert all(f"`{name}`" in book or f"| {name} " in book for name in table.names)


def test_what_was_recorded_is_what_is_exported(browser, rows, study, write):
    browser.reach_trials()
    browser.play(1)
    browser.stop(1, 4250, pauses=1, paused_ms=1500)
    browser.answer(1, "B", confidence=3)
    _, folder = write()
    row = read_table(TRIALS, folder / "trials.parquet").row(0, named=True)
    (stored,) = rows(trials)
    stimulus = study.pool.stimuli[stored.stimulus]
    assert (row["guess"], row["confidence"], row["stop_time_s"]) == ("B", 3, 4.25)
    assert (row["goal"], row["scenario"], row["maze"]) == (
        stimulus.goal,
        stimulus.scenario,
        stimulus.maze,
    )
    assert row["correct"] == (stimulus.goal == "B")
    assert row["length_s"] == stimulus.steps
    assert row["steps_seen"] == 5
    assert (row["pauses"], row["paused_s"], row["lead_in_s"]) == (1, 1.5, 1.5)
    assert row["prediction_time_s"] == (4.25 if row["correct"] else stimulus.steps)
    assert row["answered_at"] == stored.answered_at
    assert row["condition"] == rows(places)[0].condition


def test_csv_jsonl_and_parquet_say_the_same(browser, write):
    browser.take_part()
    _, folder = write()
    for table in (TRIALS, PARTICIPANTS, EVENTS):
        frames = [
            read_table(table, folder / f"{table.name}.{f}") for f in ("csv", "jsonl", "parquet")
        ]
        assert frames[0].equals(frames[1])
        assert frames[0].equals(frames[2])


def test_pilots_are_exported_only_if_asked_for(browser, another_browser, write):
    browser.reach_trials("?simulated=1")
    browser.finish_trial(1)
    previewer = another_browser()
    previewer.reach_trials("?preview=1")
    previewer.finish_trial(1)
    assert write()[0] == {"trials": 0, "participants": 0, "events": 0}
    counts, folder = write(simulated=True)
    assert (counts["trials"], counts["participants"]) == (2, 2)
    table = pl.read_parquet(folder / "trials.parquet")
    assert table["simulated"].to_list() == [True, False]
    assert table["preview"].to_list() == [False, True]


def test_recruiter_ids_are_never_exported(browser, write):
    browser.take_part("?PROLIFIC_PID=prolific-person&STUDY_ID=study-9&SESSION_ID=session-9")
    _, folder = write()
    for file in folder.iterdir():
        content = file.read_bytes()
        assert b"prolific-person" not in content
        assert b"session-9" not in content


def test_whoever_withdrew_is_a_row_without_facts(browser, write):
    browser.take_part()
    browser.post("/withdraw")
    counts, folder = write()
    assert (counts["trials"], counts["events"]) == (0, 0)
    row = read_table(PARTICIPANTS, folder / "participants.csv").row(0, named=True)
    assert row["status"] == "withdrawn"
    assert row["age"] is None
    assert row["user_agent"] is None


def test_exporting_an_empty_study_gives_empty_tables_with_their_columns(write):
    counts, folder = write()
    assert set(counts.values()) == {0}
    assert tuple(pl.read_csv(folder / "trials.csv").columns) == TRIALS.names


def test_exporting_does_not_change_the_database(browser, write, settings):
    browser.take_part()
    with sqlite3.connect(settings.database_file) as before:
        dump = list(before.iterdump())
    write()
    with sqlite3.connect(settings.database_file) as after:
        assert list(after.iterdump()) == dump


def test_details_of_events_stay_json(browser, write):
    browser.reach_trials()
    browser.play(1)
    _, folder = write()
    for text in pl.read_csv(folder / "events.csv")["details"].to_list():
        assert isinstance(json.loads(text), dict)


def test_what_the_hashes_stand_for_and_the_anonymous_counts_are_exported(browser, write, study):
    browser.post("/consent", {"decision": "no"})
    browser.take_part()
    _, folder = write()
    about = json.loads((folder / "study.json").read_text(encoding="utf-8"))
    assert about["counts"] == {"arrived, no consent": 1}
    (row,) = set(pl.read_csv(folder / "trials.csv")["study_hash"])
    assert about["studies"][row]["consent_text"] == study.consent_text


def test_the_number_of_pilots_left_out_is_told(browser, client, study, tmp_path):
    browser.consent("?preview=1")
    database = client.app.state.services.database
    assert export(database, study, tmp_path / "a", simulated=False).pilots_left_out == 1
    assert export(database, study, tmp_path / "b", simulated=True).pilots_left_out == 0
