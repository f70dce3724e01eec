"""The export: what was recorded, derived once, readable by the analysis."""

import json
import sqlite3

import polars as pl

from analysis import EVENTS, PARTICIPANTS, TRIALS, read_dataset, read_table
from app.export import export
from app.tables import places, trials
from policies import first_decision, scene_maze
from tests import messages


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
    browser.consent(decision="no")
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


def test_a_stop_is_too_fast_before_the_first_decision_is_complete(browser, rows, study, write):
    browser.reach_trials()
    decisions_ms = []
    for index, early_ms in enumerate((0, 0.1, -100), start=1):
        browser.play(index)
        shown = study.pool.stimuli[rows(trials)[-1].stimulus]
        maze = scene_maze(study.pool.scenes[shown.maze])
        decisions_ms.append(1000 * first_decision(maze, shown.cells))
        browser.stop(index, decisions_ms[-1] - early_ms)
        browser.answer(index)
    _, folder = write()
    table = read_table(TRIALS, folder / "trials.parquet")
    assert table["first_decision_s"].to_list() == [ms / 1000 for ms in decisions_ms]
    assert table["too_fast"].to_list() == [False, True, False]


def test_who_watches_to_the_end_is_never_too_fast(browser, rows, write):
    browser.reach_trials()
    browser.play(1)
    browser.stop(1, rows(trials)[0].length_ms, reached_end=True)
    browser.answer(1)
    _, folder = write()
    assert read_table(TRIALS, folder / "trials.parquet")["too_fast"].to_list() == [False]


def columns(folder, *names):
    """Those columns of the participants, a row each in the order of their arrival."""
    return read_table(PARTICIPANTS, folder / "participants.parquet").select(names).rows()


def test_a_participants_row_sums_up_how_they_took_part(browser, another_browser, write):
    hasty, careful, newcomer = browser, another_browser(), another_browser()
    hasty.reach_trials()
    for index in (1, 2, 3):
        hasty.play(index)
        hasty.stop(index, 0, pauses=1, focus_losses=2, frames_dropped=20)
        hasty.answer(index, "C", pointer_moved=False)
    careful.reach_trials()
    careful.finish_trial(1, "A", 9000)
    careful.finish_trial(2, "B", 9000)
    newcomer.consent()
    _, folder = write()
    assert columns(folder, "never_moved_pointer", "same_guess", "same_confidence") == [
        (True, True, True),
        (False, False, True),
        (None, None, None),
    ]
    counts = ("too_fast_trials", "pauses", "focus_losses", "frames_dropped")
    assert columns(folder, *counts) == [(3, 3, 6, 60), (0, 0, 0, 0), (0, 0, 0, 0)]


def test_whether_the_pointer_moved_stays_empty_where_the_page_did_not_tell(browser, write):
    browser.reach_trials()
    browser.play(1)
    browser.stop(1, 5000)
    browser.answer(1, pointer_moved=None)
    _, folder = write()
    assert read_table(TRIALS, folder / "trials.csv")["pointer_moved"].to_list() == [None]
    assert columns(folder, "never_moved_pointer") == [(None,)]


PAGES = ("about_you_s", "instructions_s", "practice_s", "trials_s")


def test_time_at_each_step_is_that_of_the_servers_clock(browser, wait, write):
    browser.consent()
    wait(60.5)
    browser.post("/about-you", messages.ABOUT_ME)
    wait(20)
    browser.post("/instructions")
    for attempt, answer in enumerate(("end", "know"), start=1):
        wait(15)
        browser.post("/practice", messages.control(answer, attempt))
    for index in range(1, 11):
        wait(31)
        browser.finish_trial(index)
    wait(3600)
    _, folder = write()
    assert columns(folder, *PAGES) == [(60.5, 20, 30, 310)]


def test_time_at_a_step_is_empty_unless_it_was_finished(browser, another_browser, wait, write):
    screened_out, failed, going = browser, another_browser(), another_browser()
    for one in (screened_out, failed, going):
        one.reach_practice()
        wait(15)
    for attempt in (1, 2):
        screened_out.post("/practice", messages.control("end", attempt))
    failed.post("/failed")
    _, folder = write()
    assert columns(folder, *PAGES) == [(0, 0, 45, None), (0, 0, None, None), (0, 0, None, None)]


def test_the_analysis_finds_no_contradiction_in_what_is_exported(browser, another_browser, write):
    for number, one in enumerate((browser, *(another_browser() for _ in range(3)))):
        one.reach_trials()
        for index in range(1, 4):
            one.finish_trial(index, "ABCDEF"[index * number % 6], 700.0 * index)
    another_browser().consent()
    _, folder = write()
    data = read_dataset(folder)
    assert data.participants is not None
    assert (len(data.trials), len(data.participants)) == (12, 5)
