"""Two tries at the control question, and no third one."""

import json
from typing import Any

import pytest
from playwright.sync_api import Page, Route, expect

from tests.browser import walk
from tests.browser.conftest import Site, Visit

NOT_QUITE = "Not quite"
SCREENED_OUT = "Thank you, the study ends here"


@pytest.fixture
def page(visit: Visit) -> Page:
    """At the control question, after the practice."""
    page = visit()
    walk.reach_practice(page)
    page.goto("/practice")
    walk.practise(page)
    return page


def heading(page: Page, text: str) -> None:
    expect(page.get_by_role("heading", level=1).and_(page.locator(":visible"))).to_have_text(text)


def answer_twice(page: Page, value: str) -> None:
    """Send the form again, because the first reply got lost."""
    page.route("**/practice", lose_reply, times=1)
    with page.expect_event("requestfailed"):
        walk.answer_control(page, value)
    page.get_by_role("button", name="Answer").click()


def lose_reply(route: Route) -> None:
    assert route.fetch(max_redirects=0).status == 303
    route.abort("aborted")


def tries(site: Site) -> list[Any]:
    """The answers that were judged, as the log tells them."""
    return [json.loads(event["details"]) for event in site.events("control_answered")]


def test_whoever_is_right_at_the_second_try_goes_on(site: Site, page: Page):
    walk.answer_control(page, "turn")
    heading(page, NOT_QUITE)
    expect(page.get_by_role("alert")).to_contain_text("You have one more try.")
    walk.answer_control(page, "know")
    walk.round_is(page, 1)
    (participant,) = site.rows("select * from participants")
    assert (participant["step"], participant["control_tries"]) == ("trials", 2)
    assert participant["finished_at"] is None
    assert tries(site) == [{"answer": "turn", "attempt": 1}, {"answer": "know", "attempt": 2}]
    dealt = site.rows("select number, participant_id from places where dealt_at is not null")
    assert dealt == [{"number": 0, "participant_id": participant["id"]}]


def test_whoever_is_wrong_twice_is_screened_out_and_finds_no_third_try(site: Site, page: Page):
    answer_twice(page, "end")
    heading(page, NOT_QUITE)
    page.go_back()
    heading(page, NOT_QUITE)
    stale = page.context.new_page()
    stale.goto("/practice")
    page.bring_to_front()
    answer_twice(page, "turn")
    heading(page, SCREENED_OUT)
    expect(page.locator(".code")).to_have_text("OUT1")
    page.go_back()
    heading(page, SCREENED_OUT)
    walk.answer_control(stale, "know")
    heading(stale, SCREENED_OUT)
    (participant,) = site.rows("select * from participants")
    assert (participant["step"], participant["control_tries"]) == ("screened_out", 2)
    assert participant["finished_at"] is not None
    assert tries(site) == [{"answer": "end", "attempt": 1}, {"answer": "turn", "attempt": 2}]
    assert site.rows("select * from places where dealt_at is not null") == []
