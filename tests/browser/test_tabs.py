"""One tab and one browser at a time."""

from playwright.sync_api import expect

from tests.browser import walk
from tests.browser.conftest import STEP_MS, Guard, Site, Visit


def test_a_second_tab_is_told_and_may_take_over_where_the_first_one_was(site: Site, visit: Visit):
    first = visit()
    walk.reach_trials(first)
    walk.play(first, 2 * STEP_MS)
    second = first.context.new_page()
    second.goto("/trial")
    told = "The study is already open in another tab"
    expect(second.get_by_role("heading", name=told)).to_be_visible()
    expect(second.locator("#play")).to_be_hidden()
    second.get_by_role("button", name="Use this tab instead").click()
    walk.phase(second, "paused")
    went_on = "You went on in another tab"
    expect(first.get_by_role("heading", name=went_on)).to_be_visible()
    first.locator("#other-tab").focus()
    first.keyboard.press("Space")
    assert first.locator("#stage").get_attribute("data-phase") == "paused"
    second.click("#play")
    walk.phase(second, "moving")
    walk.stop(second)
    walk.answer(second, "C", 3)
    walk.round_is(second, 2)
    (row,) = site.trials()
    assert row["guess"] == "C"
    assert row["stop_time_ms"] >= 2 * STEP_MS
    assert row["pauses"] == 1
    assert len(site.events("second_tab")) == 1
    first.get_by_role("button", name="Use this tab instead").click()
    walk.round_is(first, 2)


def test_whoever_went_on_in_another_browser_is_told_here(site: Site, visit: Visit, guard: Guard):
    guard.expected = ("409",)
    link = "/?PROLIFIC_PID=5f1e0c2a9b3d4e6f7a8b9c0d&STUDY_ID=s1&SESSION_ID=t1"
    here = visit()
    walk.reach_trials(here, link)
    walk.play(here, 3 * STEP_MS)
    elsewhere = visit()
    elsewhere.goto(link)
    walk.phase(elsewhere, "paused")
    expect(here.get_by_role("heading", level=1)).to_have_text("You went on in another browser")
    (row,) = site.trials()
    assert row["stop_time_ms"] is None
    state = elsewhere.evaluate("fetch('/api/trial').then(reply => reply.json())")
    assert state["trial"]["position_ms"] >= 3 * STEP_MS
    elsewhere.click("#play")
    walk.phase(elsewhere, "moving")
    walk.stop(elsewhere)
    (row,) = site.trials()
    assert row["stop_time_ms"] >= 3 * STEP_MS
