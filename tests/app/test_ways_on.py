"""Where error pages lead: never to a place where one person becomes two."""

import re

import pytest
from starlette.testclient import TestClient

from app import arrival, enrolment
from app.errors import DatabaseUnavailable
from app.main import create_app
from app.tables import participants
from tests import messages
from tests.app.conftest import ORIGIN, Browser

LINK = "?PROLIFIC_PID=p1&STUDY_ID=s1&SESSION_ID=x1"


def way_on(reply):
    """Where the page's button leads; None without one."""
    found = re.search(r'<a class="button primary" href="(.*?)">Back to the study', reply.text)
    return found and found[1].replace("&amp;", "&")


@pytest.mark.parametrize("path", ["/about-you", "/trial", "/end", "/withdraw", "/nowhere"])
def test_without_a_session_no_button_leads_away_from_the_invitation(browser, path):
    reply = browser.get(path)
    assert reply.status_code in (401, 404)
    assert way_on(reply) is None
    assert 'href="/"' not in reply.text
    assert "your invitation link" in reply.text


def test_a_session_that_is_gone_leads_nowhere(browser, rows):
    browser.consent(LINK)
    browser.client.cookies.clear()
    browser.client.cookies.set("goalguess_session", "forgotten")
    reply = browser.get("/about-you")
    assert reply.status_code == 401
    assert way_on(reply) is None
    browser.consent(LINK)
    assert len(rows(participants)) == 1


def test_who_has_a_session_is_led_to_their_own_page(browser):
    browser.reach_practice(LINK)
    reply = browser.get("/nowhere")
    assert way_on(reply) == "/end"
    assert browser.get("/end").headers["location"] == "/practice"


def test_a_request_with_an_invitation_is_led_back_by_it(browser):
    assert way_on(browser.get(f"/nowhere{LINK}&junk=1")) == f"/{LINK}"
    assert way_on(browser.get("/nowhere?preview=1")) == "/?preview=1"
    form = {**browser.consent_form(LINK), "decision": "maybe"}
    assert way_on(browser.post("/consent", form)) == f"/{LINK}"
    plain = {**browser.consent_form(), "decision": "maybe"}
    assert way_on(browser.post("/consent", plain)) == "/"


@pytest.mark.parametrize("query", ["", LINK])
def test_a_crash_on_arrival_offers_the_same_link_again(settings, monkeypatch, query):
    def crash(*_arguments):
        raise RuntimeError("crash")

    monkeypatch.setattr(arrival, "find", crash)
    with TestClient(create_app(settings), base_url=ORIGIN, raise_server_exceptions=False) as client:
        assert way_on(Browser(client).get(f"/{query}")) == f"/{query}"


def test_while_nothing_can_be_stored_no_button_loses_what_was_filled_in(browser, monkeypatch):
    def unavailable(*_arguments):
        raise DatabaseUnavailable("study.sqlite: its disk is full")

    browser.consent(LINK)
    monkeypatch.setattr(enrolment, "describe", unavailable)
    reply = browser.post("/about-you", messages.ABOUT_ME)
    assert (reply.status_code, way_on(reply)) == (503, None)
    assert "load this page again" in reply.text
    assert "disk" not in reply.text


@pytest.mark.parametrize("reach", ["consent", "reach_trials", "take_part"])
def test_who_does_not_withdraw_after_all_goes_back_to_their_own_page(browser, rows, reach):
    getattr(browser, reach)()
    page = browser.get("/withdraw").text
    (back,) = re.findall(r'<a class="button" href="(.*?)">Go back to the study', page)
    reply = browser.client.get(back)
    assert reply.status_code == 200
    assert "I agree and take part" not in reply.text
    assert len(rows(participants)) == 1
