"""The keyboard reaches everything, also what the whole study by keyboard passes by."""

from itertools import pairwise
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from app.settings import Settings
from tests.browser import walk
from tests.browser.conftest import DESKTOP, PHONE, Guard, Site, Visit
from tests.browser.focus import focused, tab, tab_around, tab_to
from tests.browser.tour import EXPECTED, tour

SIZES: Any = (PHONE, DESKTOP)


@pytest.fixture
def settings(settings: Settings) -> Settings:
    """A robot slow enough to be still in motion when Tab has been around the page."""
    return settings.model_copy(update={"step_ms": 400, "lead_in_ms": 400})


def test_tab_reaches_every_control_in_reading_order_outlined_and_in_view(
    visit: Visit, guard: Guard
):
    guard.expected = EXPECTED
    page = visit()
    for stop in tour(page):
        for viewport in SIZES:
            page.set_viewport_size(viewport)
            around = tab_around(page)
            assert [one.stop for one in around] == list(range(len(around))), stop
            assert [one.text for one in around if not one.seen] == [], stop
            for one, following in pairwise(around):
                assert one.reads_before(following), (stop, one.text, following.text)


def heading(page: Page, text: str) -> None:
    expect(page.get_by_role("heading", level=1)).to_have_text(text)


def press(page: Page, text: str) -> None:
    """Tab to a button or link and press it."""
    assert tab_to(page, text).seen
    page.keyboard.press("Enter")


def test_declining(site: Site, visit: Visit):
    page = visit()
    page.goto("/")
    press(page, "No, thank you")
    heading(page, "You are not taking part")
    assert tab_to(page, "Return my submission").seen
    assert site.rows("select count from tallies") == [{"count": 1}]


def test_an_error_in_the_form_leads_to_its_question(visit: Visit, guard: Guard):
    guard.expected = ("422",)
    page = visit(viewport=PHONE)
    page.goto("/")
    press(page, "I agree and take part")
    page.wait_for_url("**/about-you")
    press(page, "Continue")
    expect(page.get_by_role("alert")).to_contain_text("6 answers")
    press(page, "What is your nationality?")
    assert focused(page).seen
    expect(page.locator("label[for=q-nationality]")).to_be_in_viewport(ratio=1)
    page.keyboard.type("Portuguese")
    expect(page.locator("#q-nationality")).to_have_value("Portuguese")
    page.reload()
    press(page, "What is your gender?")
    assert focused(page).outlined
    assert tab(page).text == "Woman"


def test_thinking_better_of_withdrawing_and_practising_again(visit: Visit):
    page = visit()
    walk.reach_practice(page)
    page.goto("/practice")
    press(page, "Withdraw from the study")
    heading(page, "Withdraw from the study?")
    press(page, "Go back to the study")
    page.wait_for_url("**/practice")
    practise(page)
    practise_again(page)
    answer_control(page, arrows=0)
    heading(page, "Not quite")
    practise_again(page)
    answer_control(page, arrows=1)
    page.wait_for_url("**/trial")


def practise_again(page: Page) -> None:
    press(page, "Practise again")
    walk.ready(page)
    assert focused(page).text == "Play"
    assert focused(page).seen
    practise(page)


def practise(page: Page) -> None:
    """One practice, from wherever the focus is to the question about the rules."""
    walk.ready(page)
    page.keyboard.press("Space")
    walk.phase(page, "moving")
    page.keyboard.press("Space")
    walk.phase(page, "stopped")
    assert focused(page).outlined
    page.keyboard.type("a4")
    page.keyboard.press("Enter")
    expect(page.locator("#control h1")).to_be_focused()


def answer_control(page: Page, *, arrows: int) -> None:
    """Choose the first answer, or one that the arrows lead to."""
    assert tab(page).seen
    page.keyboard.press("Space")
    for _ in range(arrows):
        page.keyboard.press("ArrowDown")
        assert focused(page).seen
    press(page, "Answer")


def test_taking_a_tab_over_and_getting_out_of_trouble(site: Site, visit: Visit, guard: Guard):
    guard.expected = ("422",)
    first = visit()
    walk.reach_trials(first)
    first.keyboard.press("Space")
    walk.moved(first, 100)
    page = first.context.new_page()
    page.goto("/trial")
    press(page, "Use this tab instead")
    walk.phase(page, "paused")
    page.keyboard.press("Space")
    walk.moved(page, 200)
    page.keyboard.press("Space")
    walk.phase(page, "stopped")
    page.route("**/answered", lambda route: route.fulfill(status=422, body="{}"))
    page.keyboard.type("b3")
    page.keyboard.press("Enter")
    expect(page.locator("#trouble")).to_be_visible()
    press(page, "Try again")
    expect(page.locator("#trouble")).to_be_visible()
    page.unroute("**/answered")
    press(page, "Try again")
    walk.round_is(page, 2)
    assert focused(page).seen
    page.route("**/played", lambda route: route.fulfill(status=422, body="{}"))
    page.keyboard.press("Space")
    expect(page.locator("#trouble")).to_be_visible()
    press(page, "End the study here")
    heading(page, "The study ended early")
    assert site.rows("select step from participants") == [{"step": "failed"}]


def test_withdrawing_from_the_last_page(site: Site, visit: Visit):
    page = visit()
    walk.reach_trials(page)
    walk.send_rounds(page, range(1, 11))
    page.goto("/end")
    assert tab_to(page, "Return to the recruiting site").seen
    press(page, "Withdraw from the study")
    heading(page, "Withdraw from the study?")
    press(page, "Withdraw and delete everything")
    heading(page, "You have withdrawn")
    assert site.trials() == []
