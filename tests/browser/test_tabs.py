"""One tab and one browser at a time."""

from playwright.sync_api import Route, expect

from tests import messages
from tests.browser import walk
from tests.browser.conftest import STEP_MS, Guard, Site, Visit

OPEN_ALREADY = "The study is already open in another tab"
SETTLED = """() => document.querySelector("#stage[data-phase=ready]:not(.settling)")
    || !document.querySelector("#other-tab").hidden"""
# Lets tabs of one page claim the study `after` so many ms each; which of them hold it in the end?
CLAIM = """async ([address, after, frozen_ms]) => {
    const { Tabs } = await import(address);
    const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
    const name = crypto.randomUUID();
    const holders = new Set();
    const claims = after.map(async (ms, tab) => {
        const tabs = new Tabs(name, { yield: () => holders.delete(tab), newcomer() {} });
        if (ms) await pause(ms);
        if (await tabs.claim()) holders.add(tab);
    });
    const until = performance.now() + frozen_ms;
    while (performance.now() < until); // neither questions nor answers get through meanwhile
    await Promise.all(claims);
    await pause(50);
    return [...holders];
}"""


def test_a_second_tab_is_told_and_may_take_over_where_the_first_one_was(site: Site, visit: Visit):
    first = visit()
    walk.reach_trials(first)
    walk.play(first, 2 * STEP_MS)
    second = first.context.new_page()
    second.goto("/trial")
    expect(second.get_by_role("heading", name=OPEN_ALREADY)).to_be_visible()
    expect(second.locator("#play")).to_be_hidden()
    expect(second.locator("#round")).to_be_hidden()  # this tab does not know which one it is
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
    expect(elsewhere.get_by_role("heading", level=1)).to_have_text("Go on in this browser?")
    walk.phase(here, "moving")  # nobody has gone on anywhere yet
    elsewhere.get_by_role("button", name="Go on here").click()
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


def test_of_tabs_that_claim_the_study_together_one_gets_it(visit: Visit):
    page = visit()
    page.goto("/")
    style = page.evaluate("document.querySelector('link[rel=stylesheet]').href")
    address = style.replace("style.css", "tabs.js")
    for after in ([0, 0], [0, 0, 0, 0], [0, 70], [0, 140, 40]):
        for frozen_ms in (0, 400):
            holders = page.evaluate(CLAIM, [address, after, frozen_ms])
            assert len(holders) == 1, (after, frozen_ms)


def test_of_two_tabs_opened_in_the_same_instant_one_plays_and_the_other_is_told(
    site: Site, visit: Visit
):
    one = visit()
    walk.reach_practice(one)
    walk.post(one, "/practice", messages.control("know"))
    other = one.context.new_page()
    loading: list[Route] = []

    def load_together(route: Route) -> None:
        loading.append(route)
        if len(loading) == 2:
            for held in loading:
                held.continue_()

    one.context.route("**/tabs.js", load_together)
    for tab in (one, other):
        tab.goto("/trial", wait_until="commit")
    for tab in (one, other):
        tab.wait_for_function(SETTLED)
    told = [tab for tab in (one, other) if tab.get_by_role("heading", name=OPEN_ALREADY).count()]
    (playing,) = {one, other} - set(told)
    playing.bring_to_front()
    walk.play(playing)
    walk.stop(playing)
    walk.answer(playing, "E", 4)
    walk.round_is(playing, 2)
    assert [row["guess"] for row in site.trials()] == ["E"]


def test_two_people_in_one_browser_never_answer_for_each_other(
    site: Site, visit: Visit, guard: Guard
):
    guard.expected = ("409",)
    link = "/?PROLIFIC_PID=5f1e0c2a9b3d4e6f7a8b9c{}&STUDY_ID=s1&SESSION_ID=t1"
    ann = visit()
    walk.reach_trials(ann, link.format("01"))
    walk.play(ann, STEP_MS)
    bob = ann.context.new_page()
    walk.reach_trials(bob, link.format("02"))
    ann.bring_to_front()
    if ann.locator("#stage").get_attribute("data-phase") == "paused":
        ann.click("#play")
    walk.phase(ann, "moving")
    walk.stop(ann)
    told = ann.get_by_role("heading", name="Somebody else has begun in this browser")
    expect(told).to_be_visible()
    assert [row["stop_time_ms"] for row in site.trials()] == [None]
    bob.bring_to_front()
    walk.play(bob, STEP_MS)
    walk.stop(bob)
    walk.answer(bob, "B", 2)
    walk.round_is(bob, 2)
    assert [row["guess"] for row in site.trials()] == [None, "B"]
    ann.goto(link.format("01"))
    ann.get_by_role("button", name="Go on here").click()
    walk.phase(ann, "stopped")  # the stop that had waited was delivered
    walk.answer(ann, "A", 7)
    walk.round_is(ann, 2)
    assert [row["guess"] for row in site.trials()] == ["A", "B"]
