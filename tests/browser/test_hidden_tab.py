"""A tab that is really hidden, behind another one: the robot waits, and no time runs."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, BrowserContext, expect

from tests import messages
from tests.browser import chromium, walk
from tests.browser.conftest import STEP_MS, Guard, Site, Visit
from tests.browser.serving import free_port

LEAST_HIDDEN_MS = 400


@pytest.fixture
def window(browser: Browser, guard: Guard) -> Iterator[BrowserContext]:
    """A window in which only the tab in front is visible, as for a participant.

    Pages of contexts that Playwright makes count as visible wherever they are; the context it
    finds in a running browser can be left as it is.
    """
    chrome, port = browser.browser_type, free_port()
    flags = [*chromium.FLAGS, f"--remote-debugging-port={port}"]
    launched = chrome.launch(executable_path=chromium.find(), args=flags)
    joined = chrome.connect_over_cdp(f"http://127.0.0.1:{port}", no_defaults=True)
    (window,) = joined.contexts
    window.on("page", guard.watch)
    yield window
    joined.close()
    launched.close()


def test_a_hidden_tab_pauses_and_motion_time_does_not_run(
    site: Site, visit: Visit, window: BrowserContext
):
    elsewhere = visit()
    walk.reach_practice(elsewhere)
    walk.post(elsewhere, "/practice", messages.control("know"))
    window.add_cookies(elsewhere.context.cookies())  # type: ignore[arg-type]
    page = window.new_page()
    page.goto(f"{site.url}/trial")
    walk.play(page, STEP_MS)
    other = window.new_page()
    other.bring_to_front()
    page.wait_for_function("document.hidden", polling=20)  # a hidden tab gets no frames
    other.wait_for_timeout(LEAST_HIDDEN_MS)
    page.bring_to_front()
    expect(page.locator("#prompt")).to_have_text("Paused. The robot waits for you.")
    page.get_by_role("button", name="Continue").click()
    walk.moved(page, 2 * STEP_MS)
    walk.stop(page)
    walk.answer(page, "E", 2)
    walk.round_is(page, 2)
    (row,) = site.trials()
    at = {
        kind: event["client_time_ms"]
        for kind in ("played", "hidden", "visible", "continued", "stopped")
        for event in site.events(kind)
    }
    assert list(at.values()) == sorted(at.values())
    assert at["visible"] - at["hidden"] >= LEAST_HIDDEN_MS
    assert row["pauses"] == 1
    # From where the robot stood, a frame or more before the browser says that it hid the page.
    assert 0 <= row["paused_ms"] - (at["continued"] - at["hidden"]) < LEAST_HIDDEN_MS
    in_motion = at["stopped"] - at["played"] - row["paused_ms"]
    assert row["press_ms"] == pytest.approx(in_motion, abs=0.2)
    assert row["stop_time_ms"] <= row["press_ms"]
