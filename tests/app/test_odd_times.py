"""Times that cannot be: clamped, stored and flagged, so that nobody is stuck with them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.answering import stop_time_ms
from app.schemas import Stopped
from app.tables import events, trials
from tests import messages

POSITION = st.floats(0, 30_000)


@pytest.fixture
def moving(browser, rows):
    """A browser whose first trial is moving, and the trial's length, ms."""
    browser.reach_trials()
    browser.play(1)
    return browser, rows(trials)[0].length_ms


def stored(rows):
    (row,) = rows(trials)
    return row


@pytest.mark.parametrize("press_ms", [890, 1518, 3254, 6644])
def test_a_stop_pressed_while_the_page_was_frozen_lies_at_the_last_frame_drawn(
    moving, rows, press_ms
):
    browser, _ = moving
    browser.stop(1, press_ms, last_frame_ms=700, frame_interval_ms=16.7)
    row = stored(rows)
    assert (row.stop_time_ms, row.press_ms, row.last_frame_ms) == (716.7, press_ms, 700)
    assert row.times_clamped is True
    assert browser.answer(1, "B", stop_time_ms=press_ms).json()["repeated"] is False
    assert stored(rows).guess == "B"


def test_a_stop_within_a_frame_of_the_last_one_is_the_press(moving, rows):
    browser, _ = moving
    browser.stop(1, 710.2, last_frame_ms=700, frame_interval_ms=16.7)
    assert (stored(rows).stop_time_ms, stored(rows).times_clamped) == (710.2, False)


@pytest.mark.parametrize("stop_ms", [1e12, 40_000])
def test_a_stop_beyond_the_end_lies_at_the_end_and_holds_nobody_up(moving, rows, stop_ms):
    browser, length_ms = moving
    assert browser.stop(1, stop_ms).status_code == 200
    row = stored(rows)
    assert (row.stop_time_ms, row.reached_end, row.times_clamped) == (length_ms, True, True)
    reply = browser.answer(1, "B").json()
    assert (reply["repeated"], reply["trial"]["index"]) == (False, 2)


def test_the_end_is_reached_at_the_length_and_nowhere_else(moving, rows):
    browser, _ = moving
    browser.stop(1, 3000, reached_end=True)
    assert stored(rows).reached_end is False
    browser.answer(1)
    browser.play(2)
    browser.stop(2, rows(trials)[1].length_ms, reached_end=True)
    assert (rows(trials)[1].reached_end, rows(trials)[1].times_clamped) == (True, False)


def test_a_time_that_cannot_be_flags_its_trial_and_is_logged_as_it_came(moving, rows):
    browser, _ = moving
    browser.stop(1, 3000, paused_ms=-5)
    assert (stored(rows).paused_ms, stored(rows).times_clamped) == (0, True)
    (note,) = [row for row in rows(events) if row.type == "mended"]
    assert (note.trial_index, note.details) == (1, {"paused_ms": "-5.0"})


def test_what_is_mended_beside_times_flags_no_time(moving, rows):
    browser, _ = moving
    browser.stop(1, 3000, pauses=-1, events=[{"type": "of-a-later-version"}])
    assert stored(rows).times_clamped is False
    (note,) = [row for row in rows(events) if row.type == "mended"]
    assert note.details == {"pauses": "-1.0", "events_left_out": 1}


def test_a_later_message_that_is_right_takes_no_flag_away(moving, rows):
    browser, _ = moving
    browser.stop(1, 3000, paused_ms=-5)
    browser.answer(1)
    assert stored(rows).times_clamped is True


def test_a_page_that_waited_says_for_how_long(browser, rows):
    browser.reach_trials()
    browser.play(1, waited_ms=60_000)
    browser.stop(1, 3000, waited_ms=50_000)
    assert (stored(rows).played_waited_ms, stored(rows).stopped_waited_ms) == (60_000, 50_000)


@pytest.mark.parametrize(("waited_ms", "took_ms"), [(0, 4000), (4000, 100)])
def test_how_long_the_first_message_took_is_known_with_the_stop(browser, rows, waited_ms, took_ms):
    browser.reach_trials()
    browser.play(1, waited_ms=waited_ms)
    browser.stop(1, 3000, played_took_ms=took_ms)
    assert stored(rows).played_waited_ms == 4000


def test_an_answer_belongs_to_the_stop_as_it_was_pressed_or_as_it_is_stored(moving):
    browser, _ = moving
    browser.stop(1, 3254, last_frame_ms=700, frame_interval_ms=16.7)
    assert browser.answer(1, "B", stop_time_ms=3000).json()["repeated"] is True
    assert browser.answer(1, "C", stop_time_ms=716.7).json()["repeated"] is False  # reloaded


@given(POSITION, st.none() | POSITION, st.floats(0, 100), st.floats(100, 30_000))
def test_no_stop_lies_beyond_press_frame_or_end(press, last_frame, interval, length):
    message = Stopped.model_validate(
        {
            **messages.stopped(press),
            "last_frame_ms": last_frame,
            "frame_interval_ms": interval,
        }
    )
    stop = stop_time_ms(message, length)
    drawn = press if last_frame is None else last_frame + interval
    assert stop == min(press, drawn, length)
