"""Whose page speaks: other browsers, other people in one browser, other invitations."""

import re
import sqlite3
from typing import Any

import pytest

from app import participant, trials_api
from app.tables import demographics, events, participants, places, trials
from tests import messages

ANN = "?PROLIFIC_PID=ann&STUDY_ID=s1&SESSION_ID=x1"
ANN_AGAIN = "?PROLIFIC_PID=ann&STUDY_ID=s1&SESSION_ID=x2"
BOB = "?PROLIFIC_PID=bob&STUDY_ID=s1&SESSION_ID=x3"
GOES_ON = "Go on in this browser?"
HAS_ENDED = "You have taken part already"

STEPS = {
    "consent": lambda browser: browser.consent(ANN),
    "practice": lambda browser: browser.reach_practice(ANN),
    "trials": lambda browser: browser.reach_trials(ANN),
    "moving": lambda browser: (browser.reach_trials(ANN), browser.play(1)),
    "end": lambda browser: browser.take_part(ANN),
}


def location(response):
    return response.headers["location"]


def pseudonyms(rows):
    return [row.pseudonym for row in rows(participants)]


def dump(settings):
    with sqlite3.connect(settings.database_file) as connection:
        return list(connection.iterdump())


ROUTES: list[Any] = [*participant.router.routes, *trials_api.routes]
PATHS = [
    *sorted({route.path for route in ROUTES if "GET" in route.methods}),
    *(f"/{link}" for link in (ANN, ANN_AGAIN, BOB, "?preview=1", "nowhere")),
]
"""Whatever can be opened."""


# --- looking changes nothing ---------------------------------------------------------------------


@pytest.mark.parametrize("step", STEPS)
def test_nothing_that_is_only_looked_at_changes_what_is_stored(
    browser, another_browser, settings, step
):
    STEPS[step](browser)
    before = dump(settings)
    for visitor in (browser, another_browser()):
        for path in PATHS:
            visitor.get(path)
            visitor.client.head(path, follow_redirects=False)
    assert dump(settings) == before


def test_who_lost_their_place_is_dealt_another_by_no_look(browser, client, settings):
    browser.reach_trials()
    database = client.app.state.services.database
    database.submit(
        lambda c: c.execute(places.update().values(participant_id=None, dealt_at=None))
    ).result()
    before = dump(settings)
    browser.get("/trial")
    browser.get("/api/trial")
    assert dump(settings) == before
    assert browser.send("/api/place", {}).json()["trial"]["index"] == 1


def test_until_the_button_is_pressed_the_first_browser_keeps_the_session(browser, another_browser):
    browser.reach_trials(ANN)
    other = another_browser()
    assert GOES_ON in other.get("/" + ANN).text
    assert browser.play(1).status_code == 200
    assert location(other.go_on_here(ANN)) == "/trial"
    assert browser.stop(1, 3000).json()["error"]["code"] == "moved"
    assert other.stop(1, 3000).status_code == 200


def test_consenting_again_in_another_browser_asks_whether_to_go_on_there(browser, another_browser):
    other = another_browser()
    form = {**other.hidden_fields("/" + ANN), "decision": "yes"}
    browser.reach_practice(ANN)
    sent_on = location(other.post("/consent", form))
    assert GOES_ON in other.get(sent_on).text
    assert browser.get("/practice").status_code == 200


def test_a_press_on_agree_that_was_sent_twice_leads_on_at_once(browser, another_browser, rows):
    form = {**browser.hidden_fields("/" + ANN), "decision": "yes"}
    browser.post("/consent", form)
    unanswered = another_browser()  # the browser, before it has the first reply's cookie
    assert location(unanswered.post("/consent", form)) == "/about-you"
    assert unanswered.get("/about-you").status_code == 200
    assert len(rows(participants)) == 1


def test_a_button_of_somebody_unknown_leads_to_the_consent_page(browser):
    reply = browser.post("/go-on", {"PROLIFIC_PID": "nobody"})
    assert location(reply) == "/?PROLIFIC_PID=nobody"


# --- other invitations of the same person --------------------------------------------------------


def test_another_submission_of_the_same_id_is_the_same_person(browser, another_browser, rows):
    browser.reach_trials(ANN)
    other = another_browser()
    other.go_on_here(ANN_AGAIN)
    for index in range(1, 11):
        other.finish_trial(index)
    assert len(rows(participants)) == 1
    assert "DONE1" in other.get("/end").text


def test_the_end_is_shown_elsewhere_with_the_code_of_the_same_invitation(browser, another_browser):
    browser.take_part(ANN)
    other = another_browser()
    assert HAS_ENDED in other.get("/" + ANN).text
    assert location(other.go_on_here(ANN)) == "/end"
    assert "DONE1" in other.get("/end").text


@pytest.mark.parametrize("link", [ANN_AGAIN, "?PROLIFIC_PID=ann"])
def test_another_invitation_never_gets_the_code_of_the_first(browser, another_browser, link):
    browser.take_part(ANN)
    other = another_browser()
    other.go_on_here(link)
    assert "all 10 rounds are in" in other.get("/end").text
    assert "DONE1" not in other.get("/end").text
    again = another_browser()
    again.go_on_here(ANN)
    same_browser = location(again.get("/" + link))
    assert "DONE1" not in again.get(same_browser).text
    assert "DONE1" in again.get("/end").text


def test_withdrawing_elsewhere_needs_the_invitation_it_began_with(browser, another_browser, rows):
    browser.take_part(ANN)
    other = another_browser()
    other.go_on_here(ANN_AGAIN)
    for reply in (other.get("/withdraw"), other.post("/withdraw")):
        assert reply.status_code == 403
        assert "in the browser in which you took part" in reply.text
    assert rows(participants)[0].step == "completed"
    invited = another_browser()
    invited.go_on_here(ANN)
    assert location(invited.post("/withdraw")) == "/withdrawn"
    assert rows(participants)[0].step == "withdrawn"


def test_the_very_invitation_proves_a_browser_that_came_by_another(browser, another_browser):
    browser.take_part(ANN)
    other = another_browser()
    other.go_on_here(ANN_AGAIN)
    assert other.post("/withdraw").status_code == 403
    assert "/withdraw" not in other.get("/end").text
    assert HAS_ENDED in other.get("/" + ANN).text
    assert location(other.go_on_here(ANN)) == "/end"
    assert "DONE1" in other.get("/end").text
    assert location(other.post("/withdraw")) == "/withdrawn"


def test_a_button_left_open_by_another_invitation_leads_to_no_code(browser, another_browser):
    browser.take_part(ANN)
    other = another_browser()
    left_open = other.hidden_fields("/" + ANN_AGAIN)
    other.go_on_here(ANN)
    assert "DONE1" not in other.get(location(other.post("/go-on", left_open))).text


def test_who_has_answered_in_the_other_browser_may_withdraw_there(browser, another_browser):
    browser.reach_practice("?PROLIFIC_PID=ann")
    other = another_browser()
    other.go_on_here("?PROLIFIC_PID=ann")
    assert other.post("/withdraw").status_code == 403
    other.post("/practice", messages.RIGHT_ANSWER)
    assert location(other.post("/withdraw")) == "/withdrawn"


# --- two people in one browser -------------------------------------------------------------------


@pytest.fixture
def two_people(browser, rows):
    """Ann's page is open in the browser in which Bob has begun since; the two names."""
    browser.reach_trials(ANN)
    browser.play(1)
    browser.reach_trials(BOB)
    browser.play(1)
    return pseudonyms(rows)


def test_an_answer_of_the_page_before_never_gets_into_the_other_ones_row(browser, rows, two_people):
    ann, bob = two_people
    reply = browser.stop(1, 3000, participant=ann)
    assert (reply.status_code, reply.json()["error"]["code"]) == (409, "other_participant")
    assert [row.stopped_at for row in rows(trials)] == [None, None]
    assert browser.stop(1, 4000, participant=bob).status_code == 200
    assert browser.answer(1, "C", participant=ann).status_code == 409
    gone = {"key": messages.key(), "participant": ann, "events": [messages.event("hidden")]}
    assert browser.send("/api/events", gone).status_code == 409
    assert [row.type for row in rows(events) if row.type == "hidden"] == []
    assert [(row.participant_id, row.guess) for row in rows(trials)] == [(1, None), (2, None)]


def test_the_page_before_is_not_told_where_the_other_one_is(browser, two_people):
    ann, bob = two_people
    for path in ("/api/trial", "/api/place"):
        ask = browser.get if path == "/api/trial" else lambda path: browser.send(path, {})
        assert ask(f"{path}?participant={ann}").json()["error"]["code"] == "other_participant"
        assert ask(f"{path}?participant={bob}").status_code == 200


def test_what_the_page_before_had_to_say_is_taken_when_its_participant_is_back(
    browser, rows, two_people
):
    ann, _ = two_people
    waiting = {**messages.stopped(3000), "participant": ann}
    assert browser.send("/api/trials/1/stopped", waiting).status_code == 409
    browser.go_on_here(ANN)
    assert browser.send("/api/trials/1/stopped", waiting).status_code == 200
    assert [row.stop_time_ms for row in rows(trials)] == [3000, None]


@pytest.mark.parametrize(
    ("reach", "path", "form"),
    [
        ("consent", "/about-you", messages.ABOUT_ME),
        ("reach_practice", "/practice", messages.RIGHT_ANSWER),
        ("reach_trials", "/failed", {}),
        ("reach_trials", "/withdraw", {}),
    ],
)
def test_a_form_of_the_page_before_changes_nothing_of_the_other_one(
    browser, settings, reach, path, form
):
    getattr(browser, reach)(ANN)
    fields = browser.hidden_fields("/trial" if path == "/failed" else path)
    getattr(browser, reach)(BOB)
    before = dump(settings)
    reply = browser.post(path, {**fields, **form})
    assert reply.status_code == 409
    assert "Somebody else has begun in this browser" in reply.text
    assert dump(settings) == before


def test_the_way_out_of_the_page_before_leads_nobody_else_out(browser):
    browser.reach_trials(ANN)
    (way_out,) = re.findall(r'href="(/withdraw.*?)"', browser.get("/trial").text)
    browser.reach_trials(BOB)
    assert "Somebody else has begun in this browser" in browser.get(way_out).text


def test_instructions_read_by_the_person_before_are_not_read_by_the_other(browser, rows):
    for link in (ANN, BOB):
        browser.consent(link)
        browser.post("/about-you", messages.ABOUT_ME)
    assert browser.post("/instructions", {"participant": pseudonyms(rows)[0]}).status_code == 409
    assert [row.step for row in rows(participants)] == ["instructions", "instructions"]


def test_pages_loaded_before_the_upgrade_do_not_say_whose_they_are_and_go_on(browser, rows):
    browser.take_part(ANN)  # with what pages sent before
    assert rows(participants)[0].step == "completed"
    assert len(rows(demographics)) == 1
