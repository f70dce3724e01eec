"""The clock module itself, run in a page beside a model of a few lines."""

import random
from typing import Any

import pytest
from playwright.sync_api import Page

from tests.browser.conftest import Visit

RUN = """async ([static, cases]) => {
    const { Clock } = await import(`${static}/clock.js`);
    return cases.map(({ length, start, steps }) => {
        const clock = new Clock(length, start);
        const seen = steps.map(([what, time]) => {
            clock[what](time);
            return clock.position(time);
        });
        const { pauses, pausedMs, pressMs, lastFrameMs, stoppedMs, reachedEnd } = clock;
        return { seen, pauses, pausedMs, pressMs, lastFrameMs, stoppedMs, reachedEnd };
    });
}"""

Case = dict[str, Any]

FRAME_MS = 1000 / 60


@pytest.fixture
def page(visit: Visit) -> Page:
    page = visit()
    page.goto("/")
    return page


def run(page: Page, cases: list[Case]) -> list[Case]:
    static = page.evaluate("document.querySelector('link[rel=stylesheet]').href")
    outcomes: list[Case] = page.evaluate(RUN, [static.rpartition("/")[0], cases])
    return outcomes


def one(page: Page, length: float, *steps: tuple[str, float], **start: Any) -> Case:
    return run(page, [{"length": length, "start": start, "steps": steps}])[0]


def test_a_stop_counts_from_the_first_frame_in_motion(page: Page):
    outcome = one(page, 20000, ("run", 1000.5), ("frame", 4310), ("stop", 4321.25))
    assert (outcome["stoppedMs"], outcome["lastFrameMs"]) == (3320.75, 3309.5)


def test_pauses_do_not_count(page: Page):
    steps = [("run", 100), ("frame", 590), ("pause", 600), ("run", 5600), ("frame", 5840)]
    outcome = one(page, 9000, *steps, ("stop", 5850))
    assert outcome["stoppedMs"] == 750
    assert (outcome["pauses"], outcome["pausedMs"]) == (1, 5000)


def test_a_stop_never_lies_before_the_motion_or_after_its_end(page: Page):
    assert one(page, 9000, ("run", 100), ("stop", 92))["stoppedMs"] == 0
    late = one(page, 9000, ("run", 100), ("frame", 9110), ("stop", 9900))
    assert (late["stoppedMs"], late["pressMs"], late["reachedEnd"]) == (9000, 9000, True)
    early = one(page, 9000, ("run", 100), ("frame", 9090), ("stop", 9099.9))
    assert early["reachedEnd"] is False


@pytest.mark.parametrize("what", ["stop", "pause"])
def test_while_the_page_is_frozen_nothing_is_reached_that_was_not_drawn(page: Page, what: str):
    outcome = one(page, 9000, ("run", 100), ("frame", 800), (what, 3354))
    assert outcome["seen"][-1] == pytest.approx(700 + FRAME_MS)
    if what == "stop":
        assert (outcome["pressMs"], outcome["lastFrameMs"]) == (3254, 700)


def test_the_end_is_not_reached_while_the_page_is_frozen(page: Page):
    outcome = one(page, 3000, ("run", 100), ("frame", 800), ("stop", 6744))
    assert (outcome["pressMs"], outcome["reachedEnd"]) == (3000, False)


def test_the_first_stop_is_final(page: Page):
    outcome = one(
        page,
        9000,
        *(("run", 0), ("frame", 490), ("stop", 500)),
        *(("run", 900), ("pause", 950), ("frame", 990), ("stop", 999)),
    )
    assert outcome["stoppedMs"] == 500
    assert outcome["seen"][2:] == [500] * 5


def test_motion_goes_on_where_it_was_after_a_reload(page: Page):
    outcome = one(
        page,
        9000,
        ("run", 300),
        ("frame", 390),
        ("stop", 400),
        positionMs=2500,
        pauses=1,
        pausedMs=40,
        pausedAt=-700,
    )
    assert outcome["stoppedMs"] == 2600
    assert (outcome["pauses"], outcome["pausedMs"]) == (1, 1040)


def test_a_clock_that_never_ran_stands_at_zero(page: Page):
    assert one(page, 9000, ("pause", 50), ("stop", 900))["stoppedMs"] == 0


def test_whatever_happens_it_agrees_with_a_model(page: Page):
    dice = random.Random(2)
    cases = [any_case(dice) for _ in range(400)]
    for case, outcome in zip(cases, run(page, cases), strict=True):
        moved, pauses, paused, seen = model(case)
        assert outcome["seen"] == pytest.approx(seen), case
        assert outcome["seen"] == sorted(outcome["seen"]), case
        assert (outcome["pauses"], outcome["pausedMs"]) == (pauses, pytest.approx(paused)), case
        if outcome["stoppedMs"] is not None:
            assert outcome["stoppedMs"] == pytest.approx(moved), case
            assert 0 <= outcome["stoppedMs"] <= case["length"], case


def any_case(dice: random.Random) -> Case:
    time, steps = dice.uniform(0, 1e5), []
    for _ in range(dice.randrange(1, 12)):
        time += dice.choice((0.0, dice.uniform(0, 20), dice.uniform(0, 3000)))
        steps.append((dice.choice(("run", "run", "frame", "frame", "pause", "stop")), time))
    return {"length": dice.choice((2000, 9000.5)), "start": {}, "steps": steps}


def model(case: Case) -> tuple[float, int, float, list[float]]:
    """Sums up the time between run and pause or stop, as far as it was drawn and to the length."""
    drawn, pauses, paused = 0.0, 0, 0.0  # `drawn`: at the last frame, or where the motion stands
    state, since = "waiting", 0.0  # `since`: the last frame, or the pause
    seen: list[float] = []
    for what, time in case["steps"]:
        after = time - since if what == "frame" else min(time - since, FRAME_MS)
        moved = min(drawn + after, case["length"]) if state == "running" else drawn
        if what == "run" and state in ("waiting", "paused"):
            paused += time - since if state == "paused" else 0
            state, since = "running", time
        elif what == "frame" and state == "running":
            drawn, since = moved, time
        elif what == "pause" and state == "running":
            pauses, state, drawn, since = pauses + 1, "paused", moved, since + after
        elif what == "stop":
            state, drawn = "stopped", moved
        seen.append(moved)
    return seen[-1], pauses, paused, seen


def test_late_frames_are_counted_by_the_rhythm_learnt_before(page: Page):
    static = page.evaluate("document.querySelector('link[rel=stylesheet]').href")
    dropped, rate = page.evaluate(
        """async (static) => {
            const { FrameMeter } = await import(`${static}/clock.js`);
            const meter = new FrameMeter();
            let time = 0;
            for (const gap of [8, 8, 8, 9, 8, 8, 40]) meter.frame((time += gap), false);
            for (const gap of [8, 8, 13, 8, 11, 24]) meter.frame((time += gap), true);
            meter.rest();
            meter.frame(time + 5000, true);
            return [meter.dropped, meter.refreshRateHz];
        }""",
        static.rpartition("/")[0],
    )
    assert (dropped, rate) == (2, 125)
