"""What the export says of odd rows: times that cannot be, clocks set back, values of older rows."""

import pytest
from sqlalchemy import insert, update

from analysis import EVENTS, PARTICIPANTS, TRIALS, read_dataset, read_plan, read_table, tables
from analysis.data_notices import data_notices
from app import export, export_rows
from app.repository import now
from app.tables import events, participants, trials
from tests import messages


@pytest.fixture
def store(client):
    """Runs a statement on the stored rows, as an older version may have left them."""
    database = client.app.state.services.database

    def run(statement, rows=None):
        database.submit(lambda connection: connection.execute(statement, rows)).result()

    return run


def of(folder, table, *names):
    """Those columns of a table, a row each in its order."""
    return read_table(table, folder / f"{table.name}.csv").select(names).rows()


def play_honestly(browser, wait, index, stop_s=6.0):
    """One trial in the time that it takes: a lead-in of 1.5 s, the motion, the answer."""
    wait(4)
    browser.play(index)
    wait(stop_s)
    browser.stop(index, 1000 * stop_s)
    wait(3)
    browser.answer(index)


def take_part_honestly(browser, wait):
    browser.reach_trials()
    for index in range(1, 11):
        play_honestly(browser, wait, index, stop_s=5.0 + index)


TIMES = ("server_stretch_s", "impossible_time")


def test_ten_trials_played_by_a_program_at_once_are_flagged(browser, write):
    browser.take_part()
    _, folder = write()
    assert {flag for (flag,) in of(folder, TRIALS, "impossible_time")} == {True}
    assert of(folder, PARTICIPANTS, "impossible_time") == [(True,)]


def test_whoever_takes_the_time_that_it_takes_is_not(browser, wait, write, store):
    take_part_honestly(browser, wait)
    store(update(trials).values(played_waited_ms=0))
    _, folder = write()
    assert of(folder, TRIALS, *TIMES) == [(5.0 + index, False) for index in range(1, 11)]
    assert of(folder, PARTICIPANTS, "impossible_time") == [(False,)]


def test_the_program_alone_is_left_out_and_only_by_a_plan(
    browser, another_browser, wait, write, tmp_path
):
    for honest in (browser, another_browser(), another_browser(), another_browser()):
        take_part_honestly(honest, wait)
    another_browser().take_part()
    _, folder = write()
    data = read_dataset(folder)
    assert data.trials["participant"].n_unique() == 5
    (told,) = [each.text for each in data_notices(data) if each.code == "impossible_time"]
    assert "1 of the participants analysed and 10 of the trials" in told
    (tmp_path / "plan.toml").write_text('[[exclusions]]\nrule = "impossible_time"')
    kept = read_dataset(folder, read_plan(tmp_path / "plan.toml"))
    assert len(kept.excluded[0].participants) == 1
    assert kept.trials["participant"].n_unique() == 4


def test_messages_that_waited_offline_and_came_together_are_not_flagged(
    browser, wait, write, store
):
    browser.reach_trials()
    wait(30)
    browser.play(1)
    wait(0.25)
    browser.stop(1, 12_000)
    browser.answer(1)
    store(update(trials).values(played_waited_ms=20_000, stopped_waited_ms=8000))
    _, folder = write()
    assert of(folder, TRIALS, *TIMES) == [(20.25, False)]
    store(update(trials).values(played_waited_ms=0))
    _, folder = write()
    assert of(folder, TRIALS, *TIMES) == [(0.25, True)]


def test_a_stop_before_what_the_server_knows_was_seen_is_flagged(browser, wait, write, store):
    browser.reach_trials()
    play_honestly(browser, wait, 1)
    store(update(trials).values(position_ms=6500.0))
    _, folder = write()
    assert of(folder, TRIALS, "impossible_time") == [(True,)]


def test_a_stop_that_waited_while_they_were_in_another_browser_is_no_programs(
    browser, another_browser, wait, write
):
    link = "?PROLIFIC_PID=ann&SESSION_ID=x1"
    browser.reach_trials(link)
    wait(30)
    browser.play(1)
    wait(60)
    another_browser().go_on_here(link)
    browser.go_on_here(link)
    browser.stop(1, 5000, waited_ms=55_000)
    browser.answer(1)
    _, folder = write()
    assert of(folder, TRIALS, "impossible_time", "watched_elsewhere") == [(False, True)]
    assert of(folder, PARTICIPANTS, "impossible_time") == [(False,)]


def test_simulated_participants_keep_a_clock_of_their_own(browser, write):
    browser.take_part("?simulated=1")
    _, folder = write(simulated=True)
    assert {flag for (flag,) in of(folder, TRIALS, "impossible_time")} == {None}
    assert of(folder, PARTICIPANTS, "impossible_time") == [(None,)]


PAGES = ("about_you_s", "instructions_s", "practice_s", "trials_s")


def test_a_clock_set_back_on_a_page_leaves_its_time_empty_and_is_told(
    browser, another_browser, wait, write
):
    for honest in (browser, another_browser(), another_browser()):
        take_part_honestly(honest, wait)
    odd = another_browser()
    odd.consent()
    wait(60 - 3600)
    odd.post("/about-you", messages.ABOUT_ME)
    wait(20)
    odd.post("/instructions")
    wait(30)
    odd.post("/practice", messages.RIGHT_ANSWER)
    for index in range(1, 11):
        odd.finish_trial(index)
    _, folder = write()
    assert of(folder, PARTICIPANTS, *PAGES)[-1] == (None, 20, 30, 0)
    data = read_dataset(folder)
    assert len(data.trials) == 40
    (told,) = [each.text for each in data_notices(data) if each.code == "times_missing"]
    assert told.endswith("about_you_s in 1 of participants.csv.")


def test_a_clock_set_back_during_a_motion_judges_nothing(browser, wait, write):
    browser.reach_trials()
    browser.play(1)
    wait(-3600)
    browser.stop(1, 5000)
    browser.answer(1)
    _, folder = write()
    assert of(folder, TRIALS, *TIMES) == [(None, None)]
    assert of(folder, PARTICIPANTS, "impossible_time") == [(None,)]


def test_a_log_that_tells_what_cannot_happen_stops_no_export(browser, write, store):
    browser.reach_practice()
    store(update(events).where(events.c.type == "described").values(type="passed_control"))
    _, folder = write()
    assert of(folder, PARTICIPANTS, *PAGES) == [(None,) * 4]


FROM_THE_PAGE = ("press_s", "last_frame_s", "frame_interval_s", "times_clamped")


def test_what_the_page_knew_of_its_frames_is_exported_in_seconds(browser, write, store):
    browser.reach_trials()
    browser.finish_trial(1)
    store(
        update(trials).values(
            press_ms=5012.5, last_frame_ms=4990, frame_interval_ms=16.7, times_clamped=True
        )
    )
    _, folder = write()
    assert of(folder, TRIALS, *FROM_THE_PAGE) == [(5.0125, 4.99, 0.0167, True)]
    nothing = dict.fromkeys(("press_ms", "last_frame_ms", "frame_interval_ms", "times_clamped"))
    store(update(trials).values(nothing))
    _, folder = write()
    assert of(folder, TRIALS, *FROM_THE_PAGE) == [(None,) * 4]


def event(kind, index, key):
    return {
        "participant_id": 1,
        "message_key": key,
        "ordinal": 0,
        "trial_index": index,
        "type": kind,
        "server_time": now(),
        "details": {},
        "study_hash": "study",
        "app_version": "0",
    }


def test_a_trial_that_another_browser_had_begun_is_marked(browser, write, store):
    browser.reach_trials()
    for index in (1, 2, 3):
        browser.finish_trial(index)
    store(insert(events), [event("played_elsewhere", 2, "a"), event("hidden", 3, "b")])
    _, folder = write()
    assert of(folder, TRIALS, "watched_elsewhere") == [(False,), (True,), (False,)]


def test_trial_numbers_that_no_trial_has_are_exported_as_none(browser, write, store):
    browser.consent()
    numbers = (0, 1, 10, 11, 2**62)
    store(insert(events), [event("hidden", number, f"key-{number}") for number in numbers])
    _, folder = write()
    exported = [index for kind, index in of(folder, EVENTS, "type", "trial_index")]
    assert exported[-5:] == [None, 1, 10, None, None]


def test_whether_somebody_was_recruited_is_told_until_they_withdraw(
    browser, another_browser, write
):
    browser.consent("?PROLIFIC_PID=prolific-person")
    another_browser().consent()
    _, folder = write()
    assert of(folder, PARTICIPANTS, "recruited") == [(True,), (False,)]
    browser.post("/withdraw")
    _, folder = write()
    assert of(folder, PARTICIPANTS, "recruited") == [(None,), (False,)]


@pytest.mark.parametrize("before", [None, False, True])
def test_whether_somebody_had_been_a_pilot_is_exported(browser, write, store, before):
    browser.consent()
    store(update(participants).values(pilot_before=before))
    _, folder = write()
    assert of(folder, PARTICIPANTS, "pilot_before") == [(before,)]


@pytest.mark.parametrize(
    ("stored", "exported"),
    [("mouse", "mouse"), ("keyboard", "keyboard"), ("=cmd", "other"), ("", "other"), (None, None)],
)
def test_a_pointer_of_no_known_kind_is_exported_as_other(browser, write, store, stored, exported):
    browser.consent()
    store(update(participants).values(pointer_type=stored))
    _, folder = write()
    assert of(folder, PARTICIPANTS, "pointer_type") == [(exported,)]


def test_rows_are_written_while_further_ones_are_still_to_be_read(browser, write, monkeypatch):
    browser.take_part()
    told, frame_of = [], tables.frame_of

    def framed(table, rows, first=1):
        told.append(f"{table.name} written")
        return frame_of(table, rows, first)

    def read(study, record):
        told.append("event read")
        return export_rows.event_row(study, record)

    monkeypatch.setattr(tables, "_BATCH", 2)
    monkeypatch.setattr(tables, "frame_of", framed)
    monkeypatch.setattr(export, "event_row", read)
    write()
    assert told.index("events written") == told.index("event read") + 2
