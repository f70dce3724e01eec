"""No answer is lost: over an offline minute, a restart of the server and a closed tab."""

from playwright.sync_api import Page, expect

from tests.browser import walk
from tests.browser.conftest import STEP_MS, Guard, Site, Visit

NO_CONNECTION = "No connection … trying again."
ANSWER_WAITS = "Saving … keep this page open; your answer is safe on this device."


def reach_an_answer(page: Page) -> None:
    walk.reach_trials(page)
    walk.play(page)
    walk.stop(page)


def test_an_answer_outlives_the_network_the_server_and_its_own_tab(
    site: Site, visit: Visit, guard: Guard
):
    guard.expected = ("net::ERR_INTERNET_DISCONNECTED", "net::ERR_FAILED")
    page = visit()
    browser = page.context
    walk.reach_trials(page)
    walk.play(page, STEP_MS)
    browser.set_offline(True)
    walk.stop(page)
    expect(page.locator("#saving")).to_have_text(NO_CONNECTION)
    walk.answer(page, "D", 6)
    expect(page.locator("#saving")).to_have_text(ANSWER_WAITS)
    site.server.stop()
    page.close()  # ends "offline" before the page: its last breath must find nobody to hear it
    (row,) = site.trials()
    assert (row["stop_time_ms"], row["guess"]) == (None, None)
    site.server.start()

    browser.set_offline(False)
    browser.route("**/api/**", lambda route: route.abort())  # the page loads, and no more
    page = browser.new_page()
    page.goto("/")
    expect(page.locator("#saving")).to_have_text(ANSWER_WAITS)
    browser.unroute("**/api/**")
    expect(page.locator("#saving")).to_have_text("Saved")
    walk.round_is(page, 2)
    (row,) = site.trials()
    assert (row["guess"], row["confidence"]) == ("D", 6)
    assert STEP_MS <= row["stop_time_ms"] < row["length_ms"]
    for kind in ("played", "stopped", "answered"):
        assert len(site.events(kind)) == 1, kind
    assert site.events("retried")


def test_offline_the_participant_is_told_and_goes_on_at_once_when_back(
    site: Site, visit: Visit, guard: Guard
):
    guard.expected = ("net::ERR_INTERNET_DISCONNECTED",)
    page = visit()
    reach_an_answer(page)
    page.context.set_offline(True)
    walk.answer(page, "B", 1)
    expect(page.locator("#saving")).to_have_text(ANSWER_WAITS)
    expect(page.locator("#round-index")).to_have_text("1")
    page.context.set_offline(False)
    expect(page.locator("#saving")).to_have_text("Saved")
    walk.round_is(page, 2)
    (row,) = site.trials()
    assert (row["guess"], row["confidence"]) == ("B", 1)


def test_a_server_that_restarts_under_an_open_page_is_asked_again_until_it_answers(
    site: Site, visit: Visit, guard: Guard
):
    guard.expected = ("net::ERR_CONNECTION_REFUSED",)
    page = visit()
    reach_an_answer(page)
    site.server.stop()
    with page.expect_event("requestfailed"):
        walk.answer(page, "F", 7)
    site.server.start()
    walk.round_is(page, 2)
    (row,) = site.trials()
    assert (row["guess"], row["confidence"]) == ("F", 7)
    assert len(site.events("answered")) == 1


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


def test_whoever_gives_up_ends_at_a_page_of_their_own(site: Site, visit: Visit, guard: Guard):
    guard.expected = ("422",)
    page = visit()
    reach_an_answer(page)
    page.route("**/answered", lambda route: route.fulfill(status=422, body="{}"))
    walk.answer(page, "A", 3)
    page.get_by_role("button", name="End the study here").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("The study ended early")
    assert site.rows("select step from participants") == [{"step": "failed"}]
