"""Invitation links: whom they bring, and what a page says of a link that is not as it should be."""

import logging

import pytest
from starlette.testclient import TestClient

from app import recruiter_ids
from app.main import create_app
from app.tables import participants, recruits
from tests.app.conftest import ORIGIN, Browser


@pytest.fixture
def demanding(settings):
    """A browser at a study that demands an id."""
    strict = settings.model_copy(update={"require_id": True})
    with TestClient(create_app(strict), base_url=ORIGIN) as client:
        yield Browser(client)


@pytest.fixture
def warnings(caplog):
    """What was logged, beginning with nothing noticed yet."""
    recruiter_ids._warned_of.clear()
    caplog.set_level(logging.WARNING, logger="goalguess")
    return caplog


@pytest.mark.parametrize("name", ["PROLIFIC_PID", "STUDY_ID", "SESSION_ID"])
@pytest.mark.parametrize(
    "value", ["null", "%24%7Be%3A%2F%2FField%2FPROLIFIC_PID%7D", "[PID]", "%25PID%25", "session_id"]
)
def test_a_link_that_was_not_filled_in_is_refused_in_words(browser, rows, name, value):
    reply = browser.get(f"/?{name}={value}")
    assert reply.status_code == 422
    assert "did not fill in the link" in reply.text
    assert f"{name}: expected an id" in reply.text
    assert 'class="button' not in reply.text
    form = {**browser.consent_form(), name: "null", "decision": "yes"}
    assert "did not fill in the link" in browser.post("/consent", form).text
    assert rows(participants) == []


def test_an_id_with_a_blank_behind_it_is_the_same_person(browser, another_browser, rows):
    browser.consent("?PROLIFIC_PID=abc")
    another_browser().consent("?PROLIFIC_PID=abc%20")
    another_browser().consent("?PROLIFIC_PID=%E3%80%80abc%C2%A0")
    assert [row.recruiter_id for row in rows(recruits)] == ["abc"]


def test_a_blank_id_is_none_and_two_of_them_are_two_people(browser, another_browser, rows):
    for visitor in (browser, another_browser()):
        visitor.consent("?PROLIFIC_PID=%20&STUDY_ID=s1")
    assert len(rows(participants)) == 2
    assert rows(recruits) == []


def test_who_is_stored_under_an_id_of_another_shape_still_comes_back(browser, client):
    browser.reach_practice("?PROLIFIC_PID=ada")
    database = client.app.state.services.database
    older = recruits.update().values(recruiter_id="ada@example.org")
    database.submit(lambda connection: connection.execute(older)).result()
    assert browser.get("/?PROLIFIC_PID=ada%40example.org").headers["location"] == "/practice"
    newcomer = browser.get("/?PROLIFIC_PID=bob%40example.org")
    assert newcomer.status_code == 422
    assert "came other characters too" in newcomer.text
    assert "bob" not in newcomer.text


def test_a_study_that_demands_an_id_lets_nobody_in_without(demanding):
    for query in ("", "?STUDY_ID=s1", "?PROLIFIC_PID="):
        reply = demanding.get(f"/{query}")
        assert reply.status_code == 422
        assert "PROLIFIC_PID: expected in the link" in reply.text
    form = {"arrival": "x" * 20, "decision": "yes"}
    assert demanding.post("/consent", form).status_code == 422
    assert demanding.consent("?PROLIFIC_PID=p1").headers["location"] == "/about-you"
    assert demanding.get("/").headers["location"] == "/about-you"


def test_the_page_says_under_which_name_the_id_came(demanding):
    reply = demanding.get("/?workerId=A1B2C3D4")
    assert "came workerId instead" in reply.text
    assert "A1B2C3D4" not in reply.text


@pytest.mark.parametrize("pilot", ["preview", "simulated"])
def test_a_pilot_needs_no_id_even_where_one_is_demanded(demanding, pilot):
    assert demanding.consent(f"?{pilot}=1").headers["location"] == "/about-you"


def test_an_id_under_another_name_is_logged_once_and_taken_for_none(
    browser, another_browser, rows, warnings
):
    for visitor in (browser, another_browser()):
        assert visitor.consent("?prolific_pid=p1").headers["location"] == "/about-you"
    (warning,) = warnings.messages
    assert "prolific_pid where PROLIFIC_PID is expected" in warning
    assert "p1" not in warning
    assert rows(recruits) == []


def test_a_link_with_an_id_and_another_parameter_is_no_reason_to_warn(browser, warnings):
    browser.get("/?PROLIFIC_PID=p1&id=7")
    browser.get("/?utm_source=mail")
    assert warnings.messages == []


@pytest.mark.parametrize("name", ["STUDY_ID", "SESSION_ID"])
def test_who_began_before_placeholders_were_refused_goes_on_by_the_same_link(
    browser, another_browser, name
):
    browser.reach_practice("?PROLIFIC_PID=abc")
    link = f"?PROLIFIC_PID=abc&{name}={name}"
    assert browser.get(f"/{link}").headers["location"] == "/practice"
    other = another_browser()
    assert other.go_on_here(link).headers["location"] == "/practice"
    assert other.post("/withdraw").status_code == 403
