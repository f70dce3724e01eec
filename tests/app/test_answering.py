"""The trials: what is stored, what is refused, what is kept of what comes too late."""

import pytest
from starlette.testclient import TestClient

from analysis import correct, score
from app.main import create_app
from app.study import load_study
from app.tables import events, participants, places, trials
from tests import messages
from tests.app.conftest import ORIGIN, Browser


def first_trial(browser):
    return browser.trial()["trial"]


def test_the_first_trial_is_ready_before_it_is_played(browser):
    browser.reach_trials()
    trial = first_trial(browser)
    assert (trial["index"], trial["of"], trial["phase"]) == (1, 10, "ready")


def test_a_trial_goes_from_ready_through_moving_and_asking_to_the_next(browser):
    browser.reach_trials()
    browser.play(1)
    assert first_trial(browser)["phase"] == "moving"
    browser.stop(1, 4321.5)
    trial = first_trial(browser)
    assert (trial["phase"], trial["stop_time_ms"]) == ("asking", 4321.5)
    reply = browser.answer(1).json()
    assert (reply["trial"]["index"], reply["trial"]["phase"]) == (2, "ready")
    assert reply["repeated"] is False


def test_all_facts_of_a_trial_are_stored(browser, rows):
    browser.reach_trials()
    browser.play(1, device={**messages.played("")["device"], "reduced_motion": True})
    browser.stop(
        1, 4321.5, pauses=2, paused_ms=900, focus_losses=1, frames_dropped=3, reduced_motion=True
    )
    browser.answer(1, "C", confidence=6, pointer_moved=False)
    (row,) = rows(trials)
    assert (row.stop_time_ms, row.reached_end, row.guess, row.confidence) == (4321.5, False, "C", 6)
    assert (row.pauses, row.paused_ms, row.focus_losses, row.frames_dropped) == (2, 900, 1, 3)
    assert row.reduced_motion is True
    assert (row.guess_latency_ms, row.confidence_latency_ms) == (1200.5, 800)
    assert row.pointer_moved is False
    assert row.played_at <= row.stopped_at <= row.answered_at
    assert (row.step_ms, row.lead_in_ms) == (1000, 1500)


def test_a_page_loaded_before_an_upgrade_does_not_say_whether_the_pointer_moved(browser, rows):
    browser.reach_trials()
    browser.play(1)
    browser.stop(1, 3000)
    answer = messages.answered("A", 3000)
    del answer["pointer_moved"]
    assert browser.send("/api/trials/1/answered", answer).status_code == 200
    assert rows(trials)[0].pointer_moved is None


def test_the_device_is_stored_with_the_first_frame_played(browser, rows):
    browser.reach_trials()
    browser.play(1)
    (participant,) = rows(participants)
    assert (participant.viewport_width, participant.viewport_height) == (1280, 800)
    assert (participant.refresh_rate_hz, participant.pointer_type) == (60.0, "mouse")


def test_the_stimuli_shown_are_those_of_the_place_dealt(browser, rows, study):
    browser.take_part()
    place = next(row for row in rows(places) if row.participant_id)
    shown = [study.pool.stimuli[row.stimulus] for row in rows(trials)]
    assert [one.scenario for one in shown] == place.scenarios
    assert {one.condition for one in shown} == {place.condition}


def test_the_last_answer_completes_the_study(browser, rows):
    browser.reach_trials()
    for index in range(1, 11):
        reply = browser.finish_trial(index).json()
    assert reply == {"repeated": False, "trial": None, "next": "/end"}
    assert rows(participants)[0].step == "completed"
    assert rows(participants)[0].finished_at is not None


def test_the_code_is_given_only_when_every_answer_is_there(browser):
    browser.reach_trials()
    for index in range(1, 10):
        browser.finish_trial(index)
    assert "DONE1" not in browser.get("/end").text
    browser.finish_trial(10)
    assert "DONE1" in browser.get("/end").text


def test_the_score_on_the_last_page_is_that_of_the_measures(browser, rows, study):
    browser.reach_trials()
    for index in range(1, 11):
        browser.finish_trial(index, guess="ABCDEF"[index % 6], stop_time_ms=1000 * index)
    total = 0.0
    for row in rows(trials):
        stimulus = study.pool.stimuli[row.stimulus]
        right = correct(row.guess, stimulus.goal)
        total += score(right, row.stop_time_ms / 1000, stimulus.steps)
    assert f"{total:.1f} <small>of 100 points" in browser.get("/end").text


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"guess": "G"}, "guess"),
        ({"guess": "a"}, "guess"),
        ({"confidence": 0}, "confidence"),
        ({"confidence": 8}, "confidence"),
        ({"confidence": 4.5}, "confidence"),
        ({"key": "short"}, "key"),
        ({"goal": "A"}, "goal"),
    ],
)
def test_an_impossible_answer_is_refused_by_the_name_of_its_field(browser, rows, changes, field):
    browser.reach_trials()
    browser.play(1)
    browser.stop(1, 3000)
    reply = browser.answer(1, **changes)
    assert reply.status_code == 422
    assert reply.json()["error"]["message"].startswith(field)
    assert rows(trials)[0].answered_at is None


def test_nothing_can_be_sent_ahead_of_its_turn(browser, rows):
    browser.reach_trials()
    assert browser.stop(1, 100).json()["error"]["code"] == "wrong_step"
    assert browser.answer(1).json()["error"]["code"] == "wrong_step"
    assert browser.play(2).json()["error"]["code"] == "wrong_step"
    assert rows(trials) == []


def test_a_second_stop_leaves_the_first_as_it_was(browser, rows):
    browser.reach_trials()
    browser.play(1)
    browser.stop(1, 3000)
    reply = browser.stop(1, 9000).json()
    assert reply["repeated"] is True
    assert reply["trial"]["stop_time_ms"] == 3000
    assert rows(trials)[0].stop_time_ms == 3000


def test_a_second_answer_leaves_the_first_and_gets_the_trial_that_is_due(browser, rows):
    browser.reach_trials()
    browser.finish_trial(1, guess="B")
    reply = browser.answer(1, guess="C").json()
    assert (reply["repeated"], reply["trial"]["index"]) == (True, 2)
    assert rows(trials)[0].guess == "B"


def test_a_stale_answer_after_the_end_is_told_of_the_end(browser, rows):
    browser.take_part()
    assert browser.answer(10, guess="C").json() == {"repeated": True, "trial": None, "next": "/end"}
    assert rows(trials)[9].guess == "A"


def test_a_message_delivered_twice_is_logged_once(browser, rows):
    browser.reach_trials()
    body = messages.played(first_trial(browser)["ticket"])
    for _ in range(2):
        browser.send("/api/trials/1/played", body)
    logged = [row.type for row in rows(events) if row.trial_index == 1]
    assert logged == ["shown", "played"]


def test_events_carry_times_stimulus_and_details(browser, rows):
    browser.reach_trials()
    browser.play(1, events=[messages.event("played", 1234.5, frame=7)])
    row = rows(events)[-1]
    assert (row.type, row.client_time_ms, row.details) == ("played", 1234.5, {"frame": 7})
    assert row.stimulus == rows(trials)[0].stimulus
    assert row.server_time is not None


def test_a_broken_off_trial_goes_on_where_it_was(browser):
    browser.reach_trials()
    browser.play(1)
    gone = {"key": messages.key(), "trial_index": 1, "position_ms": 2500, "events": []}
    assert browser.send("/api/events", gone).status_code == 200
    assert first_trial(browser)["position_ms"] == 2500
    browser.send("/api/events", {**gone, "key": messages.key(), "position_ms": 1000})
    assert first_trial(browser)["position_ms"] == 2500


def test_what_was_seen_never_exceeds_the_motion(browser, rows):
    browser.reach_trials()
    browser.play(1)
    gone = {"key": messages.key(), "trial_index": 1, "position_ms": 1e8, "events": []}
    browser.send("/api/events", gone)
    assert first_trial(browser)["position_ms"] == rows(trials)[0].length_ms


def test_the_trials_are_closed_to_whoever_is_not_there_yet(browser):
    browser.reach_practice()
    assert browser.play(1).json()["error"]["code"] == "wrong_step"


def test_without_a_session_nothing_is_taken(browser):
    reply = browser.play(1)
    assert (reply.status_code, reply.json()["error"]["code"]) == (401, "no_session")


def test_the_animation_of_a_place_dealt_before_is_not_taken_for_another(browser, rows):
    browser.reach_trials()
    assert browser.play(1, ticket="of-another-dealing").json()["error"]["code"] == "place_returned"
    assert rows(trials) == []


def test_a_guess_belongs_to_the_stop_it_was_made_at(browser, rows):
    browser.reach_trials()
    browser.play(1)
    browser.stop(1, 500)
    reply = browser.answer(1, "B", stop_time_ms=9000).json()
    assert (reply["repeated"], reply["trial"]["phase"]) == (True, "asking")
    assert rows(trials)[0].guess is None
    assert browser.answer(1, "C", stop_time_ms=500).json()["repeated"] is False


def test_events_of_a_message_that_comes_too_late_are_kept(browser, rows):
    browser.reach_trials()
    browser.play(1)
    browser.play(1, events=[messages.event("second_tab")])
    assert [row.type for row in rows(events)][-1] == "second_tab"


def test_what_was_seen_stays_as_it_was_at_the_stop(browser, rows):
    browser.reach_trials()
    browser.play(1)
    browser.stop(1, 3000)
    gone = {"key": messages.key(), "trial_index": 1, "position_ms": 9000, "events": []}
    browser.send("/api/events", gone)
    assert rows(trials)[0].position_ms == 0


def test_another_device_in_a_later_trial_is_logged(browser, rows):
    browser.reach_trials()
    browser.finish_trial(1)
    device = {**messages.played("")["device"], "viewport_width": 360}
    browser.play(2, device=device)
    (row,) = [row for row in rows(events) if row.type == "device_changed"]
    assert row.details["viewport_width"] == 360


def test_a_trial_begun_keeps_its_speed_and_its_study_over_a_restart(browser, rows, settings):
    browser.reach_trials()
    browser.play(1)
    length = rows(trials)[0].length_ms
    token = browser.client.cookies["goalguess_session"]
    faster = settings.model_copy(update={"step_ms": 500})
    with TestClient(create_app(faster), base_url=ORIGIN) as client:
        client.cookies.set("goalguess_session", token)
        again = Browser(client)
        assert again.current()["playback"]["step_ms"] == 1000
        assert again.stop(1, length, reached_end=True).status_code == 200
        again.answer(1)
        assert again.current()["playback"]["step_ms"] == 500
        again.play(2)
    hashes = [row.study_hash for row in rows(trials)]
    assert hashes == [load_study(settings).hash, load_study(faster).hash]


def test_an_animation_loaded_before_a_restart_at_another_speed_is_loaded_again(browser, settings):
    browser.reach_trials()
    ticket = browser.current()["ticket"]
    token = browser.client.cookies["goalguess_session"]
    faster = settings.model_copy(update={"step_ms": 500})
    with TestClient(create_app(faster), base_url=ORIGIN) as client:
        client.cookies.set("goalguess_session", token)
        again = Browser(client)
        assert again.play(1, ticket=ticket).json()["error"]["code"] == "place_returned"
        assert again.play(1).status_code == 200


def test_a_ticket_is_drawn_at_random_for_each_dealing(browser, another_browser, rows):
    browser.reach_trials()
    other = another_browser()
    other.reach_trials()
    tickets = [row.ticket for row in rows(places) if row.participant_id]
    assert len({*tickets}) == 2
    assert all(len(ticket) == 16 for ticket in tickets)
    assert browser.current()["ticket"].startswith(tickets[0])


def test_a_page_that_was_ready_before_tickets_were_random_plays_on(browser, client):
    browser.reach_trials()
    database = client.app.state.services.database
    database.submit(lambda c: c.execute(places.update().values(ticket=None))).result()
    assert browser.play(1).status_code == 200


def test_a_browser_that_played_unseen_and_was_left_is_noted_when_it_says_so(
    browser, another_browser, rows
):
    link = "?PROLIFIC_PID=ann&SESSION_ID=x1"
    browser.reach_trials(link)
    unsent = messages.played(browser.current()["ticket"])
    newer = another_browser()
    newer.go_on_here(link)
    newer.finish_trial(1)
    reply = browser.send("/api/trials/1/played", {**unsent, "waited_ms": 60_000})
    assert reply.json()["error"]["code"] == "moved"
    (note,) = [row for row in rows(events) if row.type == "played_elsewhere"]
    assert (note.trial_index, note.details) == (1, {"waited_ms": 60_000})
    assert rows(trials)[0].guess == "A"


def test_a_message_whose_reply_was_lost_before_they_moved_tells_of_nothing_unseen(
    browser, another_browser, rows
):
    link = "?PROLIFIC_PID=ann&SESSION_ID=x1"
    browser.reach_trials(link)
    sent = messages.played(browser.current()["ticket"])
    assert browser.send("/api/trials/1/played", sent).status_code == 200
    another_browser().go_on_here(link)
    assert browser.send("/api/trials/1/played", sent).json()["error"]["code"] == "moved"
    assert [row.type for row in rows(events) if row.type == "played_elsewhere"] == []
