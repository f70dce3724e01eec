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
        const { pauses, pausedMs, stoppedMs, reachedEnd } = clock;
        return { seen, pauses, pausedMs, stoppedMs, reachedEnd };
    });
}"""

Case = dict[str, Any]


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
    assert one(page, 20000, ("run", 1000.5), ("stop", 4321.25))["stoppedMs"] == 3320.75


def test_pauses_do_not_count(page: Page):
    outcome = one(page, 9000, ("run", 100), ("pause", 600), ("run", 5600), ("stop", 5850))
    assert outcome["stoppedMs"] == 750
    assert (outcome["pauses"], outcome["pausedMs"]) == (1, 5000)


def test_a_stop_never_lies_before_the_motion_or_after_its_end(page: Page):
    assert one(page, 9000, ("run", 100), ("stop", 92))["stoppedMs"] == 0
    late = one(page, 9000, ("run", 100), ("stop", 9900))
    assert (late["stoppedMs"], late["reachedEnd"]) == (9000, True)
    assert one(page, 9000, ("run", 100), ("stop", 9099.9))["reachedEnd"] is False


def test_the_first_stop_is_final(page: Page):
    outcome = one(
        page, 9000, ("run", 0), ("stop", 500), ("run", 900), ("pause", 950), ("stop", 999)
    )
    assert outcome["stoppedMs"] == 500
    assert outcome["seen"][1:] == [500, 500, 500, 500]


def test_motion_goes_on_where_it_was_after_a_reload(page: Page):
    outcome = one(
        page,
        9000,
        ("run", 300),
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
        steps.append((dice.choice(("run", "run", "pause", "position", "stop")), time))
    return {"length": dice.choice((2000, 9000.5)), "start": {}, "steps": steps}


def model(case: Case) -> tuple[float, int, float, list[float]]:
    """Sums up the time between run and pause or stop, capped at the length."""
    moved, pauses, paused = 0.0, 0, 0.0
    state, since = "waiting", 0.0
    seen: list[float] = []
    for what, time in case["steps"]:
        if state == "running":
            moved, since = min(moved + time - since, case["length"]), time
        if what == "run" and state in ("waiting", "paused"):
            paused += time - since if state == "paused" else 0
            state, since = "running", time
        elif what == "pause" and state == "running":
            pauses, state, since = pauses + 1, "paused", time
        elif what == "stop":
            state = "stopped"
        seen.append(moved)
    return moved, pauses, paused, seen


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
