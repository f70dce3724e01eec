"""About you, control question, dealing of places and withdrawal, through routes and rows."""

import sqlite3
from datetime import timedelta

import pytest
from sqlalchemy import select, update
from starlette.testclient import TestClient

from app import arrival, enrolment, repository
from app.arrival import Link
from app.main import create_app
from app.opening import open_database
from app.sessions import participant_of
from app.settings import Settings
from app.study import load_study
from app.tables import (
    demographics,
    events,
    participants,
    places,
    recruits,
    sessions,
    trials,
)
from tests import messages
from tests.app.conftest import ORIGIN, Browser

PROLIFIC = "?PROLIFIC_PID=p1&STUDY_ID=s1&SESSION_ID=x1"


def location(response):
    return response.headers["location"]


def let_time_pass(client, minutes):
    """Move all dealings into the past."""
    then = repository.now() - timedelta(minutes=minutes)
    database = client.app.state.services.database
    database.submit(
        lambda c: c.execute(
            update(places).where(places.c.dealt_at.is_not(None)).values(dealt_at=then)
        )
    ).result()


def test_answers_about_oneself_are_stored_and_can_be_withheld(browser, rows):
    browser.consent()
    form = {**messages.ABOUT_ME, "gender": "prefer not to say", "nationality": ""}
    form |= {"age": "", "age_withheld": "yes", "nationality_withheld": "yes"}
    assert location(browser.post("/about-you", form)) == "/instructions"
    (row,) = rows(demographics)
    assert (row.age, row.gender, row.nationality) == (
        None,
        "prefer not to say",
        "prefer not to say",
    )
    assert row.education == "master's degree"


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("age", "twelve", "whole number from 18 to 120"),
        ("age", "12", "whole number from 18 to 120"),
        ("age", "", "prefer not to say"),
        ("gender", "robot", "choose one of the answers shown"),
        ("nationality", "x" * 61, "at most 60 characters"),
        ("occupation", "", "prefer not to say"),
    ],
)
def test_an_impossible_answer_is_shown_again_with_what_was_expected(
    browser, rows, field, value, message
):
    browser.consent()
    reply = browser.post("/about-you", {**messages.ABOUT_ME, field: value})
    assert reply.status_code == 422
    assert message in reply.text
    assert rows(demographics) == []
    assert rows(participants)[0].step == "about_you"


def test_answers_sent_twice_are_kept_once(browser, rows):
    browser.consent()
    browser.post("/about-you", messages.ABOUT_ME)
    again = browser.post("/about-you", {**messages.ABOUT_ME, "age": "99"})
    assert location(again) == "/instructions"
    assert [row.age for row in rows(demographics)] == [31]


def test_the_control_question_is_asked_twice_then_screens_out(browser, rows):
    browser.reach_practice()
    assert location(browser.post("/practice", messages.control("end"))) == "/practice"
    assert "one more try" in browser.get("/practice").text
    assert location(browser.post("/practice", messages.control("end", 2))) == "/end"
    assert browser.get("/end").status_code == 200
    (participant,) = rows(participants)
    assert (participant.step, participant.control_tries) == ("screened_out", 2)
    assert rows(places) == []


def test_a_wrong_answer_sent_twice_is_one_try(browser, rows):
    browser.reach_practice()
    for _ in range(2):
        assert location(browser.post("/practice", messages.control("end"))) == "/practice"
    assert (rows(participants)[0].step, rows(participants)[0].control_tries) == ("practice", 1)


def test_the_second_try_may_pass(browser, rows):
    browser.reach_practice()
    browser.post("/practice", messages.control("end"))
    assert location(browser.post("/practice", messages.control("know", 2))) == "/trial"
    assert rows(participants)[0].step == "trials"


@pytest.mark.parametrize(
    ("reach", "path"),
    [("reach_practice", "/instructions"), ("reach_trials", "/failed"), ("consent", "/withdraw")],
)
def test_a_button_pressed_twice_leads_where_the_first_press_led(browser, reach, path):
    getattr(browser, reach)()
    browser.post(path)
    again = browser.post(path)
    assert again.status_code == 303
    assert browser.client.get(location(again)).status_code == 200


def test_a_place_is_dealt_only_when_the_control_question_is_passed(browser, rows):
    browser.reach_practice()
    assert rows(places) == []
    browser.post("/practice", messages.RIGHT_ANSWER)
    assert [row.participant_id for row in rows(places)] == [1, None, None, None]


def test_a_block_of_four_arrivals_holds_both_conditions_twice(another_browser, rows):
    for _ in range(4):
        another_browser().reach_trials()
    dealt = [row.condition for row in rows(places) if row.participant_id]
    assert sorted(dealt) == ["optimal", "optimal", "polmdp", "polmdp"]


def test_pilots_are_dealt_from_streams_of_their_own(browser, another_browser, rows):
    browser.reach_trials()
    another_browser().reach_trials("?preview=1")
    another_browser().reach_trials("?simulated=1")
    assert {row.stream for row in rows(places)} == {"participant", "preview", "simulated"}
    assert [row.number for row in rows(places) if row.participant_id] == [0, 0, 0]


def test_a_place_never_played_is_given_back_and_dealt_again_first(
    client, browser, another_browser, rows
):
    browser.reach_trials()
    let_time_pass(client, 31)
    next_one = another_browser()
    next_one.reach_trials()
    assert (rows(places)[0].number, rows(places)[0].participant_id) == (0, 2)
    assert browser.play(1).json()["error"]["code"] == "place_returned"
    assert browser.get("/trial").status_code == 200
    assert browser.get("/api/trial").json()["error"]["code"] == "place_returned"
    assert browser.send("/api/place", {}).json()["trial"]["phase"] == "ready"
    assert [row.participant_id for row in rows(places)][:2] == [2, 1]
    assert browser.play(1).status_code == 200


def test_a_place_is_kept_from_the_first_frame_played(client, browser, another_browser, rows):
    browser.reach_trials()
    browser.play(1)
    let_time_pass(client, 10_000)
    another_browser().reach_trials()
    assert [row.participant_id for row in rows(places)][:2] == [1, 2]
    assert browser.stop(1, 4000).status_code == 200


def test_a_place_is_not_given_back_within_the_set_time(client, browser, another_browser, rows):
    browser.reach_trials()
    let_time_pass(client, 29)
    another_browser().reach_trials()
    assert [row.participant_id for row in rows(places)][:2] == [1, 2]


def test_whoever_cannot_go_on_ends_as_failed_and_gives_the_place_back(browser, rows):
    browser.reach_trials()
    assert location(browser.post("/failed")) == "/end"
    assert rows(participants)[0].step == "failed"
    assert all(row.participant_id is None for row in rows(places))


@pytest.mark.parametrize("reach", ["consent", "reach_practice", "reach_trials", "take_part"])
def test_withdrawal_at_any_step_leaves_only_a_tombstone(browser, rows, reach):
    getattr(browser, reach)(PROLIFIC)
    assert browser.get("/withdraw").status_code == 200
    assert location(browser.post("/withdraw")) == "/withdrawn"
    assert browser.get("/withdrawn").status_code == 200
    for table in (trials, events, demographics, recruits, sessions):
        assert rows(table) == []
    (tombstone,) = rows(participants)
    assert tombstone.step == "withdrawn"
    personal = ("arrival", "user_agent", "consented_at", "viewport_width", "pointer_type")
    assert all(getattr(tombstone, name) is None for name in personal)


def test_the_browser_is_told_to_forget_a_participant_who_withdrew(browser):
    browser.consent()
    reply = browser.post("/withdraw")
    assert reply.headers["clear-site-data"] == '"cookies", "storage"'


def test_the_condition_of_a_played_place_stays_known_after_withdrawal(browser, rows):
    browser.reach_trials()
    browser.play(1)
    browser.post("/withdraw")
    assert rows(places)[0].participant_id == 1


def test_a_restored_backup_drops_those_who_withdrew(browser, settings, tmp_path):
    browser.take_part(PROLIFIC)
    backup = tmp_path / "backup.sqlite"
    with sqlite3.connect(settings.database_file) as source, sqlite3.connect(backup) as target:
        source.backup(target)
    source.close()
    target.close()
    browser.post("/withdraw")
    restored = Settings(database_url=f"sqlite:///{backup}", withdrawals=settings.withdrawals_file)
    reopened = open_database(load_study(restored))
    try:
        left = reopened.read_now(lambda c: c.execute(select(trials)).all())
        steps = reopened.read_now(lambda c: c.scalars(select(participants.c.step)).all())
    finally:
        reopened.close()
    assert left == []
    assert steps == ["withdrawn"]


def closed_to(browser, settings):
    """The same browser, after the study was closed."""
    token = browser.client.cookies["goalguess_session"]
    closed = settings.model_copy(update={"study_open": False})
    client = TestClient(create_app(closed), base_url=ORIGIN)
    client.cookies.set("goalguess_session", token)
    return client


def test_who_has_finished_can_withdraw_until_the_study_closes(browser, settings):
    browser.take_part()
    assert "/withdraw" in browser.get("/end").text
    with closed_to(browser, settings) as client:
        late = Browser(client)
        assert "/withdraw" not in late.get("/end").text
        assert late.get("/withdraw").status_code == 409
        assert "write to the researchers" in late.post("/withdraw").text


def test_who_is_on_the_way_can_withdraw_from_a_closed_study(browser, settings):
    browser.reach_trials()
    with closed_to(browser, settings) as client:
        assert location(Browser(client).post("/withdraw")) == "/withdrawn"


def test_withdrawing_before_the_first_frame_gives_the_place_back(browser, rows):
    browser.reach_trials()
    browser.post("/withdraw")
    assert all(row.participant_id is None and row.dealt_at is None for row in rows(places))


def test_after_a_withdrawal_no_file_of_the_database_holds_the_answers(browser, settings):
    browser.client.headers["user-agent"] = "Unmistakable/1.0"
    browser.take_part("?PROLIFIC_PID=unmistakable-person")
    browser.post("/withdraw")
    for file in settings.database_file.parent.iterdir():
        content = file.read_bytes()
        assert b"unmistakable-person" not in content, file
        assert b"Unmistakable/1.0" not in content, file


def test_a_withdrawal_is_noted_outside_before_it_is_committed(database, study):
    def begin(connection):
        token = arrival.consent(connection, study, messages.key(), Link(), None, "test")
        return token, participant_of(connection, token).pseudonym

    token, pseudonym = database.submit(begin).result()

    def withdraw_and_crash(connection):
        enrolment.withdraw(connection, study, token)
        raise RuntimeError("power cut")

    with pytest.raises(RuntimeError):
        database.submit(withdraw_and_crash).result()
    assert pseudonym in study.settings.withdrawals_file.read_text().split()
    database.submit(lambda c: enrolment.withdraw_again(c, study)).result()
    left = database.read_now(lambda c: c.execute(select(participants)).one())
    assert left.step == "withdrawn"


def test_a_line_cut_short_in_the_list_of_withdrawals_harms_no_other(browser, settings, rows):
    settings.withdrawals_file.write_text("abc")
    browser.consent()
    browser.post("/withdraw")
    listed = settings.withdrawals_file.read_text().split()
    assert listed == ["abc", rows(participants)[0].pseudonym]


def test_a_withdrawal_that_cannot_be_noted_is_not_done_and_may_be_tried_again(
    browser, rows, monkeypatch
):
    def refuse(_file):
        raise PermissionError(13, "Permission denied")

    browser.consent()
    with monkeypatch.context() as patched:
        patched.setattr(enrolment, "append_privately", refuse)
        assert browser.post("/withdraw").status_code == 503
    assert rows(participants)[0].step == "about_you"
    assert location(browser.post("/withdraw")) == "/withdrawn"
