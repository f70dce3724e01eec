"""Arrival: the link, consent, coming back, and which browser is the one that counts."""

import re
from datetime import timedelta

import pytest
from sqlalchemy import update
from starlette.testclient import TestClient

from app import repository
from app.main import create_app
from app.tables import (
    declined,
    events,
    participants,
    recruits,
    sessions,
    tallies,
    trials,
)
from tests.app.conftest import ORIGIN, Browser

PROLIFIC = "?PROLIFIC_PID=p1&STUDY_ID=s1&SESSION_ID=x1"


def location(response):
    return response.headers["location"]


def test_opening_the_link_stores_nothing_before_consent(browser, rows):
    browser.get("/" + PROLIFIC)
    assert rows(participants) == rows(recruits) == rows(events) == []


def test_no_consent_keeps_an_anonymous_count_and_nothing_else(browser, rows):
    assert location(browser.consent(PROLIFIC, decision="no")) == "/no-consent"
    assert browser.get("/no-consent").status_code == 200
    assert [tuple(row) for row in rows(tallies)] == [("arrived, no consent", 1)]
    assert rows(participants) == rows(recruits) == rows(events) == rows(sessions) == []


@pytest.mark.parametrize("pilot", ["preview", "simulated"])
def test_a_pilots_no_is_not_counted_among_those_who_gave_no_consent(browser, rows, pilot):
    reply = browser.consent(f"?{pilot}=1", decision="no")
    assert location(reply) == f"/no-consent?{pilot}=1"
    assert rows(tallies) == rows(declined) == []


def test_consent_makes_a_participant_with_the_hash_of_the_text_agreed_to(browser, rows, study):
    assert location(browser.consent(PROLIFIC)) == "/about-you"
    (participant,) = rows(participants)
    assert participant.step == "about_you"
    assert participant.consent_hash == study.consent_hash
    assert participant.study_hash == study.hash
    assert participant.consented_at is not None
    (recruit,) = rows(recruits)
    assert (recruit.recruiter_id, recruit.recruiter_study, recruit.recruiter_session) == (
        "p1",
        "s1",
        "x1",
    )


def test_consent_sent_twice_makes_one_participant(browser, rows):
    page = browser.get("/")

    fields = dict(re.findall(r'name="(arrival)" value="(.*?)"', page.text))
    for _ in range(2):
        browser.post("/consent", {**fields, "decision": "yes"})
    assert len(rows(participants)) == 1


def test_the_same_recruiter_id_comes_back_to_where_it_was(browser, another_browser, rows):
    browser.reach_practice(PROLIFIC)
    assert location(another_browser().go_on_here(PROLIFIC)) == "/practice"
    assert len(rows(participants)) == 1


def test_consenting_in_two_browsers_with_one_recruiter_id_makes_one_participant(
    browser, another_browser, rows
):
    other = another_browser()
    first, second = browser.get("/" + PROLIFIC), other.get("/" + PROLIFIC)
    assert first.status_code == second.status_code == 200
    browser.consent(PROLIFIC)
    other.consent(PROLIFIC)
    assert len(rows(participants)) == 1


def test_going_on_here_moves_the_session_and_the_older_browser_is_told(browser, another_browser):
    browser.reach_trials(PROLIFIC)
    newer = another_browser()
    newer.go_on_here(PROLIFIC)
    assert newer.get("/trial").status_code == 200
    told = browser.get("/trial")
    assert told.status_code == 409
    assert "another browser" in told.text
    assert browser.play(1).json()["error"]["code"] == "moved"
    assert newer.play(1).status_code == 200


def test_opening_the_link_again_in_the_same_browser_begins_no_new_session(browser, rows):
    browser.reach_practice(PROLIFIC)
    assert location(browser.get("/" + PROLIFIC)) == "/practice"
    assert len(rows(sessions)) == 1


def test_an_anonymous_participant_comes_back_by_the_browser(browser, another_browser):
    browser.reach_practice()
    assert location(browser.get("/")) == "/practice"
    assert another_browser().get("/").status_code == 200


def test_a_closed_study_says_so_and_takes_nobody_in(settings):
    closed = settings.model_copy(update={"study_open": False})
    with TestClient(create_app(closed), base_url=ORIGIN) as client:
        browser = Browser(client)
        assert "The study is closed" in browser.get("/").text
        form = {"arrival": "x" * 20, "decision": "yes"}
        assert "The study is closed" in browser.post("/consent", form).text


def test_two_consent_pages_in_one_browser_make_one_participant(browser, rows):
    pages = [browser.get("/").text for _ in range(2)]
    for page in pages:
        fields = dict(re.findall(r'name="(arrival)" value="(.*?)"', page))
        browser.post("/consent", {**fields, "decision": "yes"})
    assert len(rows(participants)) == 1
    assert browser.get("/about-you").status_code == 200


@pytest.mark.parametrize("query", ["", "?preview=1"])
def test_on_a_shared_computer_the_next_person_begins_anew(browser, query):
    browser.take_part(query)
    assert "I agree" in browser.get("/" + query).text


def test_a_preview_in_a_participants_browser_is_a_preview(browser, rows):
    browser.consent()
    browser.consent("?preview=1")
    assert [row.stream for row in rows(participants)] == ["participant", "preview"]


def test_a_recruited_participant_is_not_taken_for_a_preview_with_the_same_id(browser, rows):
    browser.consent(PROLIFIC + "&preview=1")
    browser.consent(PROLIFIC)
    assert [row.stream for row in rows(participants)] == ["preview", "participant"]


def test_a_moving_animation_goes_on_elsewhere_as_far_as_it_can_have_been_seen(
    browser, another_browser, client, rows
):
    browser.reach_trials(PROLIFIC)
    browser.play(1)
    then = repository.now() - timedelta(seconds=7)
    database = client.app.state.services.database
    database.submit(lambda c: c.execute(update(trials).values(played_at=then))).result()
    newer = another_browser()
    newer.go_on_here(PROLIFIC)
    assert 7000 <= newer.current()["position_ms"] < 9000
    database.submit(
        lambda c: c.execute(update(trials).values(played_at=then - timedelta(hours=1)))
    ).result()
    third = another_browser()
    third.go_on_here(PROLIFIC)
    assert third.current()["position_ms"] == rows(trials)[0].length_ms


def test_the_browser_that_somebody_comes_back_with_is_logged(browser, another_browser, rows):
    browser.consent(PROLIFIC)
    newer = another_browser()
    newer.client.headers["user-agent"] = "Newer/2.0"
    newer.go_on_here(PROLIFIC)
    assert [row.details["user_agent"] for row in rows(events) if row.type == "came_back"] == [
        "Newer/2.0"
    ]


def test_an_old_session_on_the_plain_link_belongs_to_somebody_else(browser, another_browser):
    browser.reach_practice(PROLIFIC)
    another_browser().go_on_here(PROLIFIC)
    assert "I agree" in browser.get("/").text
