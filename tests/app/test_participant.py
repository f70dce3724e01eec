"""The participant's pages: each at its step, and none that tells what it should not."""

import json

import pytest
from starlette.testclient import TestClient

from app.deps import PATHS
from app.main import create_app
from app.steps import Step
from app.tables import places, trials
from policies import CONDITIONS
from tests import messages
from tests.app.conftest import ORIGIN, Browser

PAGE_PATHS = ["/about-you", "/instructions", "/practice", "/trial", "/end"]
REACH = {
    "/about-you": lambda browser: browser.consent(),
    "/practice": lambda browser: browser.reach_practice(),
    "/trial": lambda browser: browser.reach_trials(),
    "/end": lambda browser: browser.take_part(),
}


@pytest.mark.parametrize("own", sorted(REACH))
def test_every_other_page_leads_to_the_participants_own(browser, own):
    REACH[own](browser)
    for path in PAGE_PATHS:
        reply = browser.get(path)
        if path == own:
            assert reply.status_code == 200
        else:
            assert (reply.status_code, reply.headers["location"]) == (303, own)


@pytest.mark.parametrize("path", [*PAGE_PATHS, "/withdraw"])
def test_without_a_session_a_page_says_how_to_begin(browser, path):
    reply = browser.get(path)
    assert reply.status_code == 401
    assert "invitation link" in reply.text


def test_every_step_has_a_page():
    assert set(PATHS) == set(Step)


@pytest.mark.parametrize(
    ("ending", "code"), [("completed", "C1"), ("screened_out", "C2"), ("failed", "C3")]
)
def test_each_ending_has_a_code_of_its_own(settings, ending, code):
    coded = settings.model_copy(
        update={"codes": {"completed": "C1", "screened_out": "C2", "failed": "C3"}}
    )
    with TestClient(create_app(coded), base_url=ORIGIN) as client:
        browser = Browser(client)
        if ending == "completed":
            browser.take_part()
        else:
            browser.reach_practice()
            if ending == "failed":
                browser.post("/failed")
            else:
                browser.post("/practice", messages.control("end", 1))
                browser.post("/practice", messages.control("end", 2))
        page = browser.get("/end").text
    assert [one for one in ("C1", "C2", "C3") if f">{one}<" in page] == [code]
    assert f"https://app.prolific.com/submissions/complete?cc={code}" in page


def test_a_preview_says_on_every_page_that_it_is_left_out_of_the_data(browser):
    browser.consent("?preview=1")
    assert "left out of the data" in browser.get("/about-you").text


def test_a_participant_is_told_nothing_of_previews(browser):
    browser.consent()
    assert "Preview" not in browser.get("/about-you").text


def test_without_a_contact_no_page_offers_one(browser):
    assert "mailto:" not in browser.get("/").text
    assert "Questions?" not in browser.get("/").text


def test_an_unanswered_control_question_is_asked_again(browser):
    browser.reach_practice()
    assert browser.post("/practice").headers["location"] == "/practice"


def test_the_practice_animation_is_for_those_at_practice(browser):
    browser.reach_practice()
    assert len(browser.get("/api/practice").json()["areas"]) == 6
    browser.post("/practice", messages.control("know"))
    assert browser.client.get("/api/practice", follow_redirects=False).status_code == 409


def test_the_playback_holds_what_is_drawn_and_nothing_else(browser):
    browser.reach_trials()
    playback = browser.trial()["trial"]["playback"]
    assert set(playback) == {"rows", "cols", "walls", "areas", "path", "step_ms", "lead_in_ms"}
    for area in playback["areas"]:
        assert set(area) == {"letter", "colour", "pattern", "cell"}
    assert [area["letter"] for area in playback["areas"]] == list("ABCDEF")


def test_nothing_a_browser_receives_before_the_end_names_condition_goal_or_stimulus(
    browser, rows, study
):
    received = []
    get, post, send = browser.get, browser.post, browser.send

    def keep(reply):
        received.append(str(reply.url) + str(reply.headers.raw) + reply.text)
        return reply

    browser.get = lambda *a, **k: keep(get(*a, **k))
    browser.post = lambda *a, **k: keep(post(*a, **k))
    browser.send = lambda *a, **k: keep(send(*a, **k))
    browser.reach_trials()
    browser.get("/trial")
    for index in range(1, 11):
        browser.trial()
        browser.finish_trial(index)
    everything = "\n".join(received)
    place = next(row for row in rows(places) if row.participant_id)
    secrets = [*CONDITIONS, *place.scenarios, study.pool.hash, study.hash]
    secrets += [row.stimulus for row in rows(trials)]
    secrets += ["goal", "legible", "scenario", "stimulus"]
    text = everything.replace("goalguess_session", "")
    assert [secret for secret in secrets if secret in text.lower()] == []


def test_playbacks_of_the_two_conditions_look_alike(study):
    def shape(value):
        if isinstance(value, dict):
            return {key: shape(inner) for key, inner in value.items()}
        return type(value).__name__

    for scenario in study.pool.scenarios:
        shapes = [
            json.dumps(shape(study.picture(study.pool.stimulus(scenario.id, condition))))
            for condition in CONDITIONS
        ]
        assert shapes[0] == shapes[1]
