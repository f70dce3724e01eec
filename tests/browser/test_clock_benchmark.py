"""The benchmark of the clock runs, and would notice a clock that is wrong."""

import dataclasses
import math
from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import Page, Route

from app.settings import Settings
from tests.benchmarks import clock, onlooker
from tests.browser.conftest import Site, Visit

Tween = Callable[[float], float]

FRAME_MS = 1000 / 60
WAYS = ["mouse", "keyboard"]


@pytest.fixture
def settings(settings: Settings) -> Settings:
    """A robot that is still in motion when Stop is pressed."""
    return settings.model_copy(update={"step_ms": 300})


@pytest.fixture(autouse=True)
def short_looks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clock, "WATCHED_MS", (50, 400))


def stops(page: Page, site: Site, count: int) -> list[clock.Stop]:
    return clock.take_stops(page, site.database, (WAYS * count)[:count], np.random.default_rng(1))


def test_what_is_stored_is_what_was_on_screen_at_the_press(site: Site, visit: Visit):
    taken = stops(visit(), site, 4)
    assert [stop.error_ms for stop in taken] == pytest.approx([0] * 4, abs=FRAME_MS)
    assert min(stop.seen.held_ms for stop in taken) >= clock.HELD_MS[0]
    assert "as stored" in clock.table(taken)


def test_a_clock_that_stops_early_is_found_out(site: Site, visit: Visit):
    def falsify(route: Route) -> None:
        source = route.fetch().text()
        route.fulfill(
            body=source.replace("stop(time) {", "stop(time) { time -= 50;"),
            content_type="text/javascript",
        )

    page = visit()
    page.route("**/clock.js", falsify)
    errors_ms = [stop.error_ms for stop in stops(page, site, 2)]
    assert errors_ms == pytest.approx([-50, -50], abs=FRAME_MS)


def test_a_press_on_a_frozen_page_is_stored_as_what_was_on_screen(site: Site, visit: Visit):
    page, rng = visit(), np.random.default_rng(1)
    taken = clock.take_stops(page, site.database, ["keyboard"] * 2, rng, frozen_ms=600)
    assert [stop.error_ms for stop in taken] == pytest.approx([0] * 2, abs=FRAME_MS)
    assert all(stop.press_ms - stop.seen.position_ms > 100 for stop in taken)
    assert all(stop.clamped for stop in taken)
    assert "2/2" in clock.frozen_table({600: taken})


def test_too_few_stops_and_too_large_errors_are_said():
    seen = onlooker.Sight(
        2000, pressed_ms=5000, handled_ms=1, held_ms=90, since_frame_ms=9, dropped=0
    )
    good = clock.Stop(seen, 4999, stored_ms=2000.1, press_ms=2000.1, dropped=0, clamped=False)
    bad = dataclasses.replace(good, stored_ms=2040)
    assert clock.shortcomings([good] * 20, 20) == []
    assert clock.shortcomings([], 20) == ["Measured 0 of 20 stops."]
    assert clock.shortcomings([good, good, bad], 3) == [
        "95th percentile 36.0 ms: expected at most 16.7."
    ]


TWEENS: dict[str, Tween] = {
    "straight": lambda share: share,
    "swinging": lambda share: (1 - math.cos(math.pi * share)) / 2,
}


@pytest.mark.parametrize("tween", TWEENS.values(), ids=TWEENS)
def test_the_onlooker_knows_the_position_however_the_motion_is_tweened(tween: Tween):
    path = [(5, 5), (5, 5), (4, 5), (5, 5), (5, 6), (5, 7), (5, 7), (6, 7), (7, 7)]
    began, step_ms, longest_gap_ms = 207.0, 300, 40
    times = began + np.random.default_rng(3).uniform(8, longest_gap_ms, 90).cumsum()
    frames = [(time, *place(path, (time - began) / step_ms, tween)) for time in times]
    first_border = began + 1.5 * step_ms  # the first step fails
    for last, time in enumerate(times):
        position = onlooker.position(frames[: last + 1], path, step_ms, time)
        if time < first_border:
            assert position is None
        elif time > first_border + longest_gap_ms:
            assert position == pytest.approx(time - began, abs=0.5)


def place(path: list[onlooker.Cell], steps: float, tween: Tween) -> tuple[float, float]:
    """Where a robot is drawn after so many steps, with fraction."""
    step = min(int(steps), len(path) - 2)
    moved = tween(min(steps - step, 1))
    (row, col), (next_row, next_col) = path[step : step + 2]
    return row + moved * (next_row - row), col + moved * (next_col - col)
