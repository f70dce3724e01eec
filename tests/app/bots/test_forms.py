"""Forms read from the study's own pages."""

import numpy as np

from app.bots.forms import Form, read_form
from app.questions import ABOUT_YOU, answers


def form_on(page) -> Form:
    form = read_form(page.text)
    assert form
    return form


def test_the_consent_form_brings_its_hidden_fields(browser):
    form = form_on(browser.get("/?PROLIFIC_PID=p1&simulated=1"))
    assert form.action == "/consent"
    assert form.hidden.keys() == {"PROLIFIC_PID", "simulated", "arrival"}


def test_whatever_is_filled_in_about_oneself_is_valid(browser):
    browser.consent()
    form = form_on(browser.get("/about-you"))
    asked = {*form.choices, *form.numbers, *form.texts}
    assert asked == {question.name for question in ABOUT_YOU}
    for seed in range(200):
        _given, wrong = answers(ABOUT_YOU, form.fill_in(np.random.default_rng(seed)))
        assert wrong == {}


def test_the_control_question_is_found_beside_the_games_own_form(browser):
    browser.reach_practice()
    form = form_on(browser.get("/practice"))
    assert form.action == "/practice"
    assert form.hidden.keys() == {"participant", "attempt"}
    assert form.choices == {"answer": ["end", "know", "turn"]}


def test_a_page_without_a_form_has_none(browser):
    assert read_form(browser.get("/no-consent").text) is None
