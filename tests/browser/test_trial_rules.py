"""What a round records, and what must not be possible in it."""

import time

import pytest
from playwright.sync_api import Page, expect

from tests.browser import walk
from tests.browser.conftest import PHONE, STEP_MS, Site, Visit

# Notes the time stamps of the first frame in motion and of every press, beside the study's code.
WITNESS = """
    window.witness = { zero: null, presses: [] };
    const request = requestAnimationFrame.bind(window);
    const phase = () => document.querySelector("#stage")?.dataset.phase;
    window.requestAnimationFrame = (callback) => request((time) => {
        const before = phase();
        callback(time);
        if (before === "counting" && phase() === "moving") witness.zero = time;
    });
    for (const type of ["pointerdown", "keydown"]) {
        addEventListener(type, (event) => witness.presses.push(event.timeStamp), true);
    }
"""


def stop_seen_by_witness(page: Page) -> float:
    seen: float = page.evaluate("witness.presses.at(-1) - witness.zero")
    return seen


def test_the_stop_time_is_the_press_minus_the_first_frame_in_motion(site: Site, visit: Visit):
    page = visit()
    page.add_init_script(WITNESS)
    walk.reach_trials(page)
    walk.play(page, 2 * STEP_MS)
    walk.stop(page)
    by_mouse = stop_seen_by_witness(page)
    walk.answer(page, "A", 4)
    walk.round_is(page, 2)
    page.keyboard.press("Space")
    walk.moved(page, 2 * STEP_MS)
    page.keyboard.press("Space")
    by_key = stop_seen_by_witness(page)
    walk.answer(page, "B", 4)
    walk.round_is(page, 3)
    for row, press_ms in zip(site.trials(), (by_mouse, by_key), strict=False):
        assert row["press_ms"] == pytest.approx(press_ms, abs=0.1)
        drawn_ms = row["last_frame_ms"] + row["frame_interval_ms"]
        assert row["stop_time_ms"] == pytest.approx(min(row["press_ms"], drawn_ms))


def test_the_press_that_plays_never_stops_however_long_it_is_held(site: Site, visit: Visit):
    page = visit()
    walk.reach_trials(page)
    for key in ("Space", "Enter"):
        page.locator("#play").focus()
        page.keyboard.down(key)
        page.keyboard.down(key)  # what holding a key sends
        if key == "Space":
            page.keyboard.up(key)
            page.keyboard.down(key)
        walk.moved(page, 2 * STEP_MS)
        page.keyboard.down(key)
        page.keyboard.up(key)
        walk.moved(page, 4 * STEP_MS)
        page.keyboard.press(key)
        walk.phase(page, "stopped")
        walk.answer(page, "A", 4)
        walk.ready(page)
    assert all(row["stop_time_ms"] >= 4 * STEP_MS for row in site.trials())


def test_a_stop_is_final_and_says_nothing_about_right_or_wrong(site: Site, visit: Visit):
    page = visit()
    walk.reach_trials(page)
    walk.play(page)
    walk.stop(page)
    expect(page.locator("#play")).to_be_hidden()
    page.keyboard.press("Space")
    page.locator("#maze").click(position={"x": 3, "y": 3})
    assert page.locator("#stage").get_attribute("data-phase") == "stopped"
    page.click("#next")
    expect(page.locator("#missing")).to_have_text("Choose an area first.")
    page.keyboard.press("c")
    page.click("#next")
    expect(page.locator("#missing")).to_have_text("Say how sure you are.")
    page.keyboard.press("5")
    page.keyboard.press("Enter")
    walk.round_is(page, 2)
    (row,) = site.trials()
    assert (row["guess"], row["confidence"]) == ("C", 5)


def test_an_area_can_be_chosen_in_the_maze(visit: Visit):
    page = visit()
    walk.reach_trials(page)
    walk.play(page)
    walk.stop(page)
    cell = walk.area_cells(page)["D"]
    page.mouse.click(cell["x"] + cell["width"] / 2, cell["y"] + cell["height"] / 2)
    expect(page.locator("input[value=D]")).to_be_checked()


def test_a_frozen_page_pauses_where_it_froze(visit: Visit):
    page = visit()
    walk.reach_trials(page)
    walk.play(page, STEP_MS)
    page.evaluate(
        "() => { const until = performance.now() + 2000; while (performance.now() < until); }"
    )
    walk.phase(page, "paused")
    reached = page.evaluate(
        """() => {
            const name = Object.keys(localStorage).find(name => name.endsWith(":reached"));
            return JSON.parse(localStorage[name]).position_ms;
        }"""
    )
    assert STEP_MS <= reached < 1500


# Holds the page up for so many milliseconds; Space is pressed in the middle by the browser itself.
FREEZE = (
    """([ms]) => { const until = performance.now() + ms; while (performance.now() < until); }"""
)


@pytest.mark.parametrize("frozen_ms", [200, 1000, 3000])
def test_a_stop_pressed_while_the_page_is_frozen_lies_at_what_was_drawn(
    site: Site, visit: Visit, frozen_ms: int
):
    page = visit()
    walk.reach_trials(page)
    walk.play(page, STEP_MS)
    session = page.context.new_cdp_session(page)
    page.evaluate(f"setTimeout(() => ({FREEZE})([{frozen_ms}]), 30)")
    time.sleep(0.03 + frozen_ms / 2000)
    key = {"key": " ", "code": "Space", "windowsVirtualKeyCode": 32}
    session.send("Input.dispatchKeyEvent", {"type": "keyDown", **key})
    walk.phase(page, "stopped")
    session.send("Input.dispatchKeyEvent", {"type": "keyUp", **key})
    walk.answer(page, "A", 4)
    walk.round_is(page, 2)
    (row,) = site.trials()
    last_ms, interval_ms = row["last_frame_ms"], row["frame_interval_ms"]
    assert row["press_ms"] > last_ms + interval_ms
    assert row["stop_time_ms"] == pytest.approx(last_ms + interval_ms)
    assert row["times_clamped"] == 1


def answer_by_keys(page: Page) -> None:
    for key in ("c", "5", "Enter"):
        page.keyboard.press(key)


def test_the_pointer_counts_as_moved_from_its_first_move_in_the_round_on(site: Site, visit: Visit):
    page = visit()
    walk.reach_trials(page)
    for index in (1, 2, 3):
        if index == 2:  # in the third round it lies still where it was left
            page.mouse.move(100, 100)
            page.mouse.move(200, 200)
        page.keyboard.press("Space")
        walk.moved(page, STEP_MS)
        page.reload()
        walk.phase(page, "paused")
        page.keyboard.press("Space")
        walk.moved(page, 2 * STEP_MS)
        page.keyboard.press("Space")
        walk.phase(page, "stopped")
        answer_by_keys(page)
        walk.round_is(page, index + 1)
    assert [row["pointer_moved"] for row in site.trials()] == [0, 1, 0]


def test_a_touch_counts_as_a_move(site: Site, visit: Visit):
    page = visit(viewport=PHONE, has_touch=True)
    walk.reach_trials(page)
    page.tap("#play")
    walk.moved(page, STEP_MS)
    page.tap("#play")
    walk.phase(page, "stopped")
    answer_by_keys(page)
    walk.round_is(page, 2)
    assert [row["pointer_moved"] for row in site.trials()] == [1]


def test_a_script_that_acts_on_the_page_moves_no_pointer(site: Site, visit: Visit):
    page = visit()
    walk.reach_trials(page)
    page.evaluate("""() => {
        const play = document.querySelector("#play");
        for (const type of ["pointermove", "pointerdown"]) {
            play.dispatchEvent(new PointerEvent(type, { bubbles: true }));
        }
        play.click();
    }""")
    walk.moved(page, STEP_MS)
    page.evaluate("document.querySelector('#play').click()")
    walk.phase(page, "stopped")
    page.evaluate("""() => {
        document.querySelector("input[name=guess]").click();
        document.querySelector("input[name=confidence]").click();
        document.querySelector("#next").click();
    }""")
    walk.round_is(page, 2)
    assert [row["pointer_moved"] for row in site.trials()] == [0]


def test_leaving_in_mid_motion_goes_on_where_it_was_never_from_the_beginning(
    site: Site, visit: Visit
):
    page = visit()
    walk.reach_trials(page)
    walk.play(page, 3 * STEP_MS)
    page.goto("about:blank")
    page.goto("/trial")
    walk.phase(page, "paused")
    (row,) = site.trials()
    assert row["position_ms"] >= 3 * STEP_MS
    page.evaluate("localStorage.clear()")  # the server knows it too
    page.click("#play")
    walk.phase(page, "moving")
    walk.stop(page)
    (row,) = site.trials()
    assert row["stop_time_ms"] >= 3 * STEP_MS
    assert [event["trial_index"] for event in site.events("interrupted")] == [1]
