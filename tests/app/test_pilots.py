"""Pilots: told so on every page, never given a code or a link, and marked when they are real."""

import re

import pytest
from starlette.testclient import TestClient

from app.main import create_app
from app.tables import participants
from tests import messages
from tests.app.conftest import ORIGIN, Browser

CODES = {
    "completed": "C-DONE",
    "no_consent": "C-NONE",
    "screened_out": "C-OUT",
    "failed": "C-FAIL",
    "withdrawn": "C-GONE",
}
BANNER = {
    "preview": "Preview: what you do here is left out of the data",
    "simulated": "Simulated: what is done here is left out of the data",
}
pilots = pytest.mark.parametrize("pilot", BANNER)


@pytest.fixture
def coded(settings):
    with TestClient(create_app(settings.model_copy(update={"codes": CODES}))) as client:
        yield client


@pytest.fixture
def come(coded):
    """Makes browsers that visit a study in which every ending has a code."""
    return lambda: Browser(TestClient(coded.app, base_url=ORIGIN))


def followed(browser, reply):
    return browser.get(reply.headers["location"])


def screen_out(browser, query):
    browser.reach_practice(query)
    browser.post("/practice", messages.control("end", 1))
    return followed(browser, browser.post("/practice", messages.control("end", 2)))


def fail(browser, query):
    browser.consent(query)
    return followed(browser, browser.post("/failed"))


def finish(browser, query):
    browser.take_part(query)
    return browser.get("/end")


def withdraw(browser, query):
    browser.consent(query)
    hidden = dict(
        re.findall(r'type="hidden" name="(.*?)" value="(.*?)"', browser.get("/withdraw").text)
    )
    first = browser.post("/withdraw", hidden)
    again = browser.post("/withdraw", hidden)
    assert first.headers["location"] == again.headers["location"]
    return followed(browser, again)


def decline(browser, query):
    return followed(browser, browser.consent(query, decision="no"))


ENDINGS = {
    "completed": finish,
    "no_consent": decline,
    "screened_out": screen_out,
    "failed": fail,
    "withdrawn": withdraw,
}


@pytest.mark.parametrize("ending", ENDINGS)
@pilots
def test_no_ending_shows_a_pilot_a_code_or_a_link_to_the_recruiter(come, ending, pilot):
    page = ENDINGS[ending](come(), f"?PROLIFIC_PID=p1&{pilot}=1").text
    assert not [code for code in CODES.values() if code in page]
    assert "prolific.com" not in page
    assert re.search("A participant finds their [a-z ]*code[a-z ]* here", page)
    assert BANNER[pilot] in page


@pytest.mark.parametrize("ending", ENDINGS)
def test_the_same_ending_shows_a_participant_both(come, ending):
    page = ENDINGS[ending](come(), "?PROLIFIC_PID=p1").text
    assert f">{CODES[ending]}<" in page
    assert f"https://app.prolific.com/submissions/complete?cc={CODES[ending]}" in page
    assert "A participant finds" not in page
    assert "left out of the data" not in page


@pilots
def test_every_page_on_the_way_tells_a_pilot(browser, pilot):
    query = f"?{pilot}=1"
    pages = [browser.get(f"/{query}")]
    browser.consent(query)
    pages.append(browser.get("/about-you"))
    pages.append(browser.post("/about-you", {}))
    browser.post("/about-you", messages.ABOUT_ME)
    pages.append(browser.get("/instructions"))
    browser.post("/instructions")
    pages.append(browser.get("/practice"))
    browser.post("/practice", messages.RIGHT_ANSWER)
    pages += [browser.get("/trial"), browser.get("/withdraw")]
    for page in pages:
        assert BANNER[pilot] in page.text


@pilots
def test_error_pages_that_know_a_pilot_say_so_too(browser, settings, pilot):
    assert BANNER[pilot] in browser.get(f"/?{pilot}=1&PROLIFIC_PID=null").text
    form = {**browser.consent_form(f"?{pilot}=1"), "decision": "maybe"}
    assert BANNER[pilot] in browser.post("/consent", form).text
    browser.take_part(f"?{pilot}=1")
    assert BANNER[pilot] in browser.get("/nowhere").text
    closed = settings.model_copy(update={"study_open": False})
    with TestClient(create_app(closed), base_url=ORIGIN) as client:
        client.cookies.set("goalguess_session", browser.client.cookies["goalguess_session"])
        assert BANNER[pilot] in Browser(client).get("/withdraw").text
        assert BANNER[pilot] in Browser(client).get(f"/?PROLIFIC_PID=new&{pilot}=1").text


@pytest.mark.parametrize("query", ["preview=0", "preview=", "preview=true", "simulated=true"])
def test_only_the_value_1_makes_a_pilot(browser, rows, query):
    browser.consent(f"?{query}")
    assert [row.stream for row in rows(participants)] == ["participant"]
    assert "left out of the data" not in browser.get("/about-you").text


@pilots
def test_who_was_a_pilot_under_the_same_id_is_marked_when_they_come_for_real(
    browser, another_browser, rows, pilot
):
    browser.take_part(f"?PROLIFIC_PID=p1&{pilot}=1")
    another_browser().consent("?PROLIFIC_PID=p1")
    another_browser().consent("?PROLIFIC_PID=p2")
    another_browser().consent()
    marks = [(row.stream, row.pilot_before) for row in rows(participants)]
    assert marks == [
        (pilot, False),
        ("participant", True),
        ("participant", False),
        ("participant", False),
    ]
