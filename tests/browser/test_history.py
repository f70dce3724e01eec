"""Back and forward: a page of before leads to where the participant is, and changes nothing."""

from playwright.sync_api import Page, expect

from tests.browser import walk
from tests.browser.conftest import STEP_MS, Site, Visit


def back_and_forward(page: Page, phase: str) -> None:
    """Leave the round both ways; each time it is there again, in the phase it must be in."""
    for leave in (page.go_back, page.go_forward):
        leave()
        page.wait_for_url("**/trial")
        walk.phase(page, phase)


def test_in_mid_round_the_robot_waits_where_it_was(site: Site, visit: Visit):
    page = visit()
    walk.reach_trials(page)
    walk.play(page, 4 * STEP_MS)
    back_and_forward(page, "paused")
    page.click("#play")
    walk.phase(page, "moving")
    walk.stop(page)
    back_and_forward(page, "stopped")
    (stopped,) = site.trials()
    walk.answer(page, "D", 2)
    walk.round_is(page, 2)
    back_and_forward(page, "ready")
    expect(page.locator("#round-index")).to_have_text("2")

    (row,) = site.trials()
    assert (row["guess"], row["pauses"]) == ("D", 1)
    assert row["stop_time_ms"] == stopped["stop_time_ms"] >= 4 * STEP_MS
    for kind in ("played", "interrupted", "continued", "stopped", "answered"):
        assert [event["trial_index"] for event in site.events(kind)] == [1], kind


def test_from_the_first_round_no_way_leads_back_into_the_practice(site: Site, visit: Visit):
    page = visit()
    walk.reach_practice(page)
    page.goto("/practice")
    walk.practise(page)
    walk.answer_control(page, "know")
    walk.ready(page)
    (place,) = site.rows("select * from places where participant_id is not null")
    back_and_forward(page, "ready")
    expect(page.locator("#round-index")).to_have_text("1")

    assert site.rows("select step, control_tries from participants") == [
        {"step": "trials", "control_tries": 1}
    ]
    assert site.rows("select * from places where participant_id is not null") == [place]
    for kind in ("control_answered", "passed_control", "dealt"):
        assert len(site.events(kind)) == 1, kind
    assert site.trials() == []
