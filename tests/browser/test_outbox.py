"""No answer is lost: over an outage, a reload and an offline minute."""

from playwright.sync_api import Page, expect

from tests.browser import walk
from tests.browser.conftest import Guard, Site, Visit


def reach_an_answer(page: Page) -> None:
    walk.reach_trials(page)
    walk.play(page)
    walk.stop(page)


def test_an_answer_survives_an_outage_and_a_reload(site: Site, visit: Visit, guard: Guard):
    guard.expected = ("net::ERR_FAILED",)
    page = visit()
    reach_an_answer(page)
    page.route("**/api/**", lambda route: route.abort())
    walk.answer(page, "D", 6)
    expect(page.locator("#saving")).to_contain_text("keep this page open")
    page.reload()
    expect(page.locator("#saving")).to_contain_text("safe on this device")
    assert site.trials()[0]["guess"] is None
    page.unroute("**/api/**")
    walk.round_is(page, 2)
    (row,) = site.trials()
    assert (row["guess"], row["confidence"]) == ("D", 6)
    walk.play(page)
    walk.stop(page)
    page.wait_for_load_state("networkidle")
    assert site.events("retried")


def test_offline_the_participant_is_told_and_goes_on_at_once_when_back(
    site: Site, visit: Visit, guard: Guard
):
    guard.expected = ("net::ERR_INTERNET_DISCONNECTED",)
    page = visit()
    reach_an_answer(page)
    page.context.set_offline(True)
    walk.answer(page, "B", 1)
    expect(page.locator("#saving")).to_contain_text("Saving")
    expect(page.locator("#round-index")).to_have_text("1")
    page.context.set_offline(False)
    expect(page.locator("#saving")).to_have_text("Saved")
    walk.round_is(page, 2)
    (row,) = site.trials()
    assert (row["guess"], row["confidence"]) == ("B", 1)


def test_a_reply_that_gets_lost_is_asked_for_again_and_stored_once(
    site: Site, visit: Visit, guard: Guard
):
    guard.expected = ("net::ERR_FAILED",)
    page = visit()
    reach_an_answer(page)
    lost: list[int] = []

    def lose_once(route):
        if lost:
            route.continue_()
        else:
            lost.append(route.fetch().status)
            route.abort()

    page.route("**/answered", lose_once)
    walk.answer(page, "A", 3)
    walk.round_is(page, 2)
    assert lost == [200]
    (row,) = site.trials()
    assert (row["guess"], row["confidence"]) == ("A", 3)
    assert len(site.events("answered")) == 1


def test_a_refusal_is_said_plainly_and_can_be_tried_again(site: Site, visit: Visit, guard: Guard):
    guard.expected = ("422",)
    page = visit()
    reach_an_answer(page)
    refusal = '{"error": {"code": "invalid", "message": "guess: expected a letter"}}'
    page.route("**/answered", lambda route: route.fulfill(status=422, body=refusal))
    walk.answer(page, "A", 3)
    expect(page.get_by_role("alert")).to_contain_text("Something went wrong")
    page.unroute("**/answered")
    page.get_by_role("button", name="Try again").click()
    walk.round_is(page, 2)
    assert site.trials()[0]["guess"] == "A"


def test_whoever_came_back_too_late_is_dealt_anew_without_doing_anything(
    site: Site, visit: Visit, guard: Guard
):
    guard.expected = ("409",)
    page = visit()
    walk.reach_trials(page)
    late = '{"error": {"code": "place_returned", "message": "came too late"}}'
    page.route("**/played", lambda route: route.fulfill(status=409, body=late), times=1)
    with page.expect_navigation(url="**/trial"):
        page.click("#play")
    walk.play(page)
    walk.stop(page)
    walk.answer(page, "B", 5)
    walk.round_is(page, 2)
    assert len(site.trials()) == 1


def test_whoever_gives_up_ends_at_a_page_of_their_own(site: Site, visit: Visit, guard: Guard):
    guard.expected = ("422",)
    page = visit()
    reach_an_answer(page)
    page.route("**/answered", lambda route: route.fulfill(status=422, body="{}"))
    walk.answer(page, "A", 3)
    page.get_by_role("button", name="End the study here").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("The study ended early")
    assert site.rows("select step from participants") == [{"step": "failed"}]
