"""What every page keeps to: security, secrets, size, targets, labels and contrast."""

import itertools
import json
import re
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, Response

from tests.browser import colours, walk
from tests.browser.conftest import DESKTOP, PHONE, Guard, Visit
from tests.browser.tour import EXPECTED, tour

SECRETS = r"(?i)\b(polmdp|optimal|legib\w*|conditions?|goals?|scenarios?|stimul\w*|arm|beta)\b"

SMALL_CONTROLS = """() => [...document.querySelectorAll("a, button, input, select, summary")]
    .filter((control) => control.type !== "hidden" && control.checkVisibility())
    .filter((control) => !control.matches(".skip"))
    .map((control) => (control.closest("label") ?? control))
    .filter((control) => {
        const box = control.getBoundingClientRect();
        return box.width < 24 || box.height < 24;
    })
    .map((control) => control.outerHTML)"""
NAMELESS = """() => [...document.querySelectorAll("a, button, input, select, canvas, progress")]
    .filter((one) => one.type !== "hidden" && one.checkVisibility())
    .filter((one) => !(one.ariaLabel || (one.labels?.[0] ?? one).textContent.trim()))
    .map((one) => one.outerHTML)"""


@pytest.mark.parametrize("viewport", [PHONE, DESKTOP], ids=["phone", "desktop"])
def test_every_page_is_safe_and_fits_and_can_be_hit_and_named(
    visit: Visit, guard: Guard, viewport: Any
):
    guard.expected = EXPECTED
    page = visit(viewport=viewport)
    for stop in tour(page):
        width = page.evaluate("document.documentElement.scrollWidth")
        assert width <= viewport["width"], stop
        assert page.evaluate(SMALL_CONTROLS) == [], stop
        assert page.evaluate(NAMELESS) == [], stop
        headings = page.get_by_role("heading", level=1)
        assert headings.count() == 1, stop
        assert_locked_down(page)
        if stop.startswith("round, ") and viewport == PHONE:
            assert lowest_control(page) <= PHONE["height"], stop


def lowest_control(page: Page) -> float:
    """Where the lowest of the game's controls ends: it must be in view without scrolling."""
    bottom: float = page.evaluate(
        """Math.max(0, ...[...document.querySelectorAll(".panel button, .panel input")]
            .filter((one) => one.checkVisibility())
            .map((one) => one.getBoundingClientRect().bottom))"""
    )
    return bottom


def assert_locked_down(page: Page) -> None:
    """The page as it is served: its policy, and no inline script, style or handler."""
    response = page.request.get(page.url)
    policy = response.headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy
    source = response.text()
    assert not re.search(r"<[^>]+\s(style|on\w+)\s*=", source), page.url
    assert not re.search(r"<(script(?![^>]*\ssrc=)|style)\b", source), page.url


def test_nothing_tells_condition_or_goal_before_the_guess(visit: Visit):
    page = visit()
    told: list[str] = []

    def note(response: Response) -> None:
        if "/static/" in response.url:
            return
        told.append(response.url)
        told.extend(f"{name}: {value}" for name, value in response.headers.items())
        told.append(response.text() if response.status == 200 else "")

    page.on("response", note)
    walk.reach_trials(page)
    for index in (1, 2):
        walk.round_is(page, index)
        walk.play(page)
        walk.stop(page)
        walk.answer(page, "A", 4)
    walk.round_is(page, 3)
    assert any('"playback"' in text for text in told)
    assert [found for text in told if (found := re.search(SECRETS, text))] == []
    state = page.evaluate("fetch('/api/trial').then((reply) => reply.json())")
    assert set(state["trial"]) == {
        *("index", "of", "phase", "position_ms", "stop_time_ms", "press_ms", "ticket", "playback")
    }
    assert set(state["trial"]["playback"]) == {
        *("rows", "cols", "walls", "areas", "path", "step_ms", "lead_in_ms")
    }
    assert re.search(SECRETS, json.dumps(state)) is None


def test_the_first_page_is_light(visit: Visit):
    page = visit()
    session = page.context.new_cdp_session(page)
    session.send("Network.enable")
    sizes: list[int] = []
    session.on("Network.loadingFinished", lambda event: sizes.append(event["encodedDataLength"]))
    page.goto("/")
    page.wait_for_load_state("networkidle")
    assert len(sizes) <= 6
    assert sum(sizes) <= 15_000


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_colours_keep_their_contrast(visit: Visit, scheme: Any):
    page = visit(color_scheme=scheme)
    page.goto("/")
    text = itertools.product(("ink", "muted", "accent", "danger"), ("page", "surface"))
    soft = (("ink", "accent-soft"), ("ink", "danger-soft"), ("ink", "sunken"))
    for front, back in (*text, *soft, ("on-accent", "accent"), ("plate-ink", "plate")):
        assert contrast(page, front, back) >= 4.5, (front, back)
    areas = [f"area-{name}" for name in ("blue", "orange", "green", "purple", "sky", "vermillion")]
    for front in (*areas, "wall", "robot", "accent"):
        assert contrast(page, front, "floor") >= 3, front
    assert contrast(page, "control-line", "surface") >= 3
    assert contrast(page, "control-line", "page") >= 3


def contrast(page: Page, front: str, back: str) -> float:
    """WCAG's contrast ratio of two colours of the style sheet."""
    return colours.contrast(brightness(page, front), brightness(page, back))


def brightness(page: Page, name: str) -> float:
    value = page.evaluate(
        "name => getComputedStyle(document.documentElement).getPropertyValue(name).trim()",
        f"--{name}",
    ).lstrip("#")
    whole = "".join(digit * 2 for digit in value) if len(value) == 3 else value
    return float(colours.luminance(np.array(list(bytes.fromhex(whole))) / 255))
