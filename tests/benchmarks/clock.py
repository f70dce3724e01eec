"""How exact recorded stop times are, beside an onlooker who shares no code with the page.

Example: python -m tests.benchmarks.clock --stops 60 --seed 1 --slowdown 1 4

Serves a study and plays it in a real browser, stopping at random moments, half of them by mouse and
half by keyboard; compares the stop times in the database with what was on screen at the press
(tests/benchmarks/onlooker.py says how that is known). Printed beside them: the same by the clock of
the program that presses, its way into the browser included; what performance.now() in a handler of
the press would have recorded; and what the time stamp of a click would have. Last, a row for each
of several times for which the page is frozen while Stop is pressed: how far the press ran ahead of
what was drawn, and what is stored.
"""

import argparse
import sqlite3
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import Browser, Page, sync_playwright

from app.settings import Settings
from tests.benchmarks import onlooker
from tests.browser import chromium, walk
from tests.browser.serving import served

TARGET_MS = 16.7  # a frame
ROUNDS = 10
WATCHED_MS = (50, 2000)  # from the first border that the robot crosses to the press
HELD_MS = (40, 160)  # from the press to the release
FROZEN_MS = (200, 1000, 3000, 6000)
FREEZE = """ms => setTimeout(() => {
    for (const until = performance.now() + ms; performance.now() < until;);
})"""

WAYS: dict[str, tuple[Callable[[Page], None], Callable[[Page], None]]] = {
    "mouse": (lambda page: page.mouse.down(), lambda page: page.mouse.up()),
    "keyboard": (lambda page: page.keyboard.down("Space"), lambda page: page.keyboard.up("Space")),
}


@dataclass(frozen=True)
class Stop:
    """One stop: as the onlooker saw it, and as it was stored."""

    seen: onlooker.Sight
    sent_ms: float
    """When this program began to press, since 1970."""
    stored_ms: float
    press_ms: float
    dropped: int
    clamped: bool

    @property
    def error_ms(self) -> float:
        """What is stored, less what was on screen."""
        return self.stored_ms - self.seen.position_ms


ERRORS: dict[str, Callable[[Stop], float]] = {
    "as stored": lambda stop: stop.error_ms,
    "as stored, from outside the browser": lambda stop: (
        stop.error_ms + stop.seen.pressed_ms - stop.sent_ms
    ),
    "by performance.now() in a handler": lambda stop: stop.seen.handled_ms,
    "by the time stamp of a click": lambda stop: stop.seen.held_ms,
}


def take_stops(
    page: Page, database: Path, ways: list[str], rng: np.random.Generator, frozen_ms: float = 0
) -> list[Stop]:
    """One participant's stops, a round each; those the onlooker cannot judge are left out."""
    onlooker.accompany(page)
    walk.reach_trials(page)
    rounds = [_round(page, index, way, rng, frozen_ms) for index, way in enumerate(ways, 1)]
    rows = zip(rounds, _last_participant(database), strict=True)
    return [Stop(seen, sent_ms, *stored) for (seen, sent_ms), stored in rows if seen]


def _round(
    page: Page, index: int, way: str, rng: np.random.Generator, frozen_ms: float
) -> tuple[onlooker.Sight | None, float]:
    """Play a round, through to the next one: what was seen of the stop, and when it was sent.

    The page is frozen for so long, and Stop pressed in the middle of that.
    """
    playback = walk.trial(page)["playback"]
    onlooker.begin(page)
    page.locator("#play").hover()
    _press(page, way, held_ms=0)
    walk.phase(page, "moving")
    page.wait_for_timeout(_first_border_ms(playback) + rng.uniform(*WATCHED_MS))
    if frozen_ms:
        page.evaluate(FREEZE, frozen_ms)
        time.sleep(frozen_ms / 2000)
    sent_ms = _press(page, way, held_ms=rng.uniform(*HELD_MS))
    walk.phase(page, "stopped")
    seen = onlooker.sight(page, playback)
    walk.answer(page, "A", 4)
    if index < ROUNDS:
        walk.round_is(page, index + 1)
    else:
        page.wait_for_url("**/end")
    return seen, sent_ms


def _press(page: Page, way: str, held_ms: float) -> float:
    """Press and release; when the press was sent."""
    press, release = WAYS[way]
    sent_ms = 1000 * time.time()
    press(page)
    page.wait_for_timeout(held_ms)
    release(page)
    return sent_ms


def _first_border_ms(playback: dict[str, Any]) -> float:
    """Motion position at which the robot leaves its first cell, ms; steps before that one fail."""
    path = playback["path"]
    step = next(step for step, cell in enumerate(path[1:]) if cell != path[0])
    return float((step + 0.5) * playback["step_ms"])


def _last_participant(database: Path) -> list[tuple[float, float, int, bool]]:
    """What is stored of the stop of each trial of the newest participant."""
    query = """select stop_time_ms, press_ms, frames_dropped, times_clamped from trials
        where participant_id = (select max(participant_id) from trials) order by trial_index"""
    with closing(sqlite3.connect(database)) as connection:
        return connection.execute(query).fetchall()


def measure(
    browser: Browser, url: str, database: Path, stops: int, slowdown: float, seed: int
) -> list[Stop]:
    """So many stops, with the page's processor slowed down so many times."""
    rng = np.random.default_rng(seed)
    ways = rng.permutation(np.resize(list(WAYS), stops)).tolist()
    taken: list[Stop] = []
    for first in range(0, stops, ROUNDS):
        page = browser.new_page(base_url=url, viewport={"width": 1280, "height": 800})
        session = page.context.new_cdp_session(page)
        session.send("Emulation.setCPUThrottlingRate", {"rate": slowdown})
        taken += take_stops(page, database, ways[first : first + ROUNDS], rng)
        page.close()
        print(f"slowed {slowdown:g} times: {len(taken)} of {stops} stops", file=sys.stderr)
    return taken


def table(stops: list[Stop]) -> str:
    """Median, 95th percentile and maximum of each way's |error|, ms, and the frames dropped."""
    lines = [f"{'|error| of the stop time, ms':36} {'median':>7} {'p95':>7} {'max':>7}"]
    for name, error in ERRORS.items():
        errors = [abs(error(stop)) for stop in stops]
        median, p95, most = np.percentile(errors, [50, 95, 100])
        lines.append(f"{name:36} {median:7.2f} {p95:7.2f} {most:7.2f}")
    ours = sum(stop.dropped for stop in stops)
    theirs = sum(stop.seen.dropped for stop in stops)
    return "\n".join([*lines, f"frames dropped: {ours} stored, {theirs} seen by the onlooker"])


def measure_frozen(
    browser: Browser, url: str, database: Path, stops: int, seed: int
) -> dict[int, list[Stop]]:
    """So many stops for each time that the page is frozen."""
    rng = np.random.default_rng(seed)
    taken = {}
    for frozen_ms in FROZEN_MS:
        page = browser.new_page(base_url=url, viewport={"width": 1280, "height": 800})
        taken[frozen_ms] = take_stops(page, database, ["keyboard"] * stops, rng, frozen_ms)
        page.close()
        print(f"frozen {frozen_ms} ms: {len(taken[frozen_ms])} of {stops} stops", file=sys.stderr)
    return taken


def frozen_table(taken: dict[int, list[Stop]]) -> str:
    """A row for each time frozen: medians of what a press gives and of what is stored, ms."""
    head = f"{'frozen, ms':>10} {'press ahead of the last frame':>30} {'press - on screen':>18}"
    lines = [f"{head} {'|stored - on screen|':>21} {'flagged':>8}"]
    for frozen_ms, stops in taken.items():
        ahead = np.median([stop.seen.since_frame_ms for stop in stops])
        by_press = np.median([stop.press_ms - stop.seen.position_ms for stop in stops])
        error = np.median([abs(stop.error_ms) for stop in stops])
        flagged = f"{sum(stop.clamped for stop in stops)}/{len(stops)}"
        lines.append(f"{frozen_ms:10} {ahead:30.0f} {by_press:18.0f} {error:21.2f} {flagged:>8}")
    return "\n".join(lines)


def shortcomings(stops: list[Stop], asked: int) -> list[str]:
    """What is wrong with the stops taken: too few of them, or too large an error."""
    found = []
    if len(stops) < asked:
        found.append(f"Measured {len(stops)} of {asked} stops.")
    p95 = np.percentile([abs(stop.error_ms) for stop in stops], 95) if stops else 0
    if p95 > TARGET_MS:
        found.append(f"95th percentile {p95:.1f} ms: expected at most {TARGET_MS}.")
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--stops", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--slowdown", type=float, nargs="+", default=[1, 4])
    parser.add_argument("--frozen", type=int, default=5, help="stops for each time frozen")
    given = parser.parse_args()
    failures = []
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        file = Path(folder) / "clock.sqlite"
        settings = Settings(
            database_url=f"sqlite:///{file}", seed=given.seed, step_ms=1000, lead_in_ms=300
        )
        browser = playwright.chromium.launch(
            executable_path=chromium.find(), args=list(chromium.FLAGS)
        )
        with served(settings) as url:
            for slowdown in given.slowdown:
                stops = measure(browser, url, file, given.stops, slowdown, given.seed)
                print(f"\nProcessor slowed {slowdown:g} times, {len(stops)} stops")
                print(table(stops))
                failures += shortcomings(stops, given.stops)
            frozen = measure_frozen(browser, url, file, given.frozen, given.seed)
            print("\nPage frozen, Stop pressed meanwhile")
            print(frozen_table(frozen))
            for stops in frozen.values():
                failures += shortcomings(stops, given.frozen)
        browser.close()
    sys.exit("\n".join(failures) or 0)


if __name__ == "__main__":
    main()
