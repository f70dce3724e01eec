"""Nothing in the game moves by itself, and nothing of it is cut off or covered."""

from typing import Any

import pytest
from playwright.sync_api import FloatRect, Page, expect

from app.settings import Settings
from tests import messages
from tests.browser import walk
from tests.browser.conftest import DESKTOP, PHONE, Guard, Visit

SIZES = [(640, 400), (667, 375), (700, 500), (900, 600), (1280, 800), (1920, 1080), (360, 740)]


@pytest.fixture
def settings(settings: Settings) -> Settings:
    """A robot slow enough that its motion outlasts the wait for a lost connection."""
    return settings.model_copy(update={"step_ms": 400})


def tops(page: Page) -> list[float]:
    measured: list[float] = page.evaluate(
        "['#maze', '#play'].map(id => document.querySelector(id).getBoundingClientRect().top)"
    )
    return measured


@pytest.mark.parametrize("viewport", [PHONE, DESKTOP], ids=["phone", "desktop"])
def test_late_saving_moves_nothing_and_is_silent_while_the_robot_moves(
    visit: Visit, guard: Guard, viewport: Any
):
    guard.expected = ("net::ERR_INTERNET_DISCONNECTED",)
    page = visit(viewport=viewport)
    walk.reach_trials(page)
    before = tops(page)
    page.context.set_offline(True)
    walk.play(page)
    saving = page.locator("#saving")
    expect(saving).to_have_text("No connection … trying again.")
    walk.phase(page, "moving")
    expect(saving).to_be_hidden()
    assert tops(page) == before
    walk.stop(page)
    expect(saving).to_be_visible()
    walk.answer(page, "B", 2)
    expect(saving).to_contain_text("your answer is safe on this device")
    page.context.set_offline(False)
    walk.round_is(page, 2)
    assert tops(page) == before


def boxes(page: Page) -> tuple[FloatRect, FloatRect]:
    maze = page.locator("#maze").bounding_box()
    panel = page.locator(".panel").bounding_box()
    assert maze
    assert panel
    return maze, panel


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_the_maze_is_whole_and_meets_no_panel(visit: Visit, width: int, height: int):
    page = visit(viewport={"width": width, "height": height})
    walk.reach_practice(page)
    page.goto("/practice")
    walk.ready(page)
    if (width, height) in ((360, 740), (1280, 800)):
        assert page.evaluate("document.documentElement.scrollHeight") <= height
    walk.post(page, "/practice", messages.control("know"))
    page.goto("/trial")
    walk.ready(page)
    assert_apart(page, width, height)
    walk.play(page)
    walk.stop(page)
    assert_apart(page, width, height)


def assert_apart(page: Page, width: int, height: int) -> None:
    maze, panel = boxes(page)
    assert maze["x"] >= 0
    assert maze["y"] >= 0
    assert maze["x"] + maze["width"] <= width
    assert maze["y"] + maze["height"] <= height
    beside = maze["x"] + maze["width"] <= panel["x"]
    above = maze["y"] + maze["height"] <= panel["y"]
    assert beside or above
    if width == 1920:
        assert maze["width"] > 750
