"""The consent form: yes, no, both, neither, and each showing of it counted once."""

import pytest

from app.arrival import new_pseudonym
from app.tables import declined, participants, tallies

DECLINED = [("arrived, no consent", 1)]


def counts(rows):
    return [tuple(row) for row in rows(tallies) if row.count]


def location(response):
    return response.headers["location"]


def test_three_presses_of_no_count_one(browser, rows):
    form = {**browser.consent_form(), "decision": "no"}
    for _ in range(3):
        assert location(browser.post("/consent", form)) == "/no-consent"
    assert counts(rows) == DECLINED


def test_two_showings_of_the_form_are_two_people(browser, rows):
    for _ in range(2):
        browser.consent(decision="no")
    assert counts(rows) == [("arrived, no consent", 2)]


@pytest.mark.parametrize("decision", [{}, {"decision": ""}, {"decision": "maybe"}])
def test_a_post_that_says_neither_yes_nor_no_is_refused_in_words(browser, rows, decision):
    reply = browser.post("/consent", {**browser.consent_form(), **decision})
    assert reply.status_code == 422
    assert "expected yes or no" in reply.text
    assert rows(tallies) == rows(declined) == rows(participants) == []


@pytest.mark.parametrize("decision", ["yes", "no"])
@pytest.mark.parametrize("arrival", ["", "short", "x" * 65, "x" * 20 + "!", "ä" * 20])
def test_a_post_that_is_no_form_of_ours_counts_nothing(browser, rows, decision, arrival):
    reply = browser.post("/consent", {"arrival": arrival, "decision": decision})
    assert reply.status_code == 422
    assert "arrival: expected the hidden field" in reply.text
    assert rows(tallies) == rows(declined) == rows(participants) == []


def test_who_says_yes_after_no_takes_part_and_is_no_longer_counted_as_a_no(browser, rows):
    form = browser.consent_form()
    browser.post("/consent", {**form, "decision": "no"})
    assert location(browser.post("/consent", {**form, "decision": "yes"})) == "/about-you"
    assert browser.get("/about-you").status_code == 200
    assert counts(rows) == []
    assert rows(declined) == []


def test_who_says_no_after_yes_is_led_to_the_withdrawal_and_not_counted(browser, rows):
    form = browser.consent_form("?PROLIFIC_PID=p1")
    browser.post("/consent", {**form, "decision": "yes"})
    assert location(browser.post("/consent", {**form, "decision": "no"})) == "/withdraw"
    assert browser.get("/withdraw").status_code == 200
    other = {**form, "arrival": "x" * 20, "decision": "no"}
    assert location(browser.post("/consent", other)) == "/withdraw"
    assert counts(rows) == []


def test_who_says_no_after_yes_is_not_counted_even_without_a_cookie(browser, rows):
    form = browser.consent_form()
    browser.post("/consent", {**form, "decision": "yes"})
    browser.client.cookies.clear()
    browser.post("/consent", {**form, "decision": "no"})
    assert counts(rows) == []


def test_a_no_is_kept_as_a_random_number_of_the_form_alone(browser, rows):
    form = browser.consent_form("?PROLIFIC_PID=p1")
    browser.post("/consent", {**form, "decision": "no"})
    assert [tuple(row) for row in rows(declined)] == [(form["arrival"],)]


def test_no_pseudonym_can_be_taken_for_a_number():
    for _ in range(200):
        pseudonym = new_pseudonym()
        assert pseudonym.isalnum()
        assert pseudonym[0] == "p"  # no digit, no e, and none of inf and nan
        with pytest.raises(ValueError, match="could not convert"):
            float(pseudonym)


def test_pseudonyms_are_made_so(browser, rows):
    browser.consent()
    assert len(rows(participants)[0].pseudonym) == len(new_pseudonym())
