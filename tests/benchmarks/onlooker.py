"""An onlooker beside the participant: says what was on screen when Stop was pressed.

The truth about a stop is the motion position that was on screen at the moment of the press. The
onlooker (onlooker.js, in the page but without the study's code) knows two things: the place where
the robot was drawn in each frame, and the time stamps that the browser gives to presses. In the
middle of step k, counted from 0, the robot crosses the border of two cells, however its motion is
tweened: there its position is (k + 1/2) step_ms. So the truth is the position at the last crossing
plus the time from there to the press. From one frame to when the next one is usually due the motion
is taken to run on, as eyes take it, and no further: a frozen page shows a still picture. What
mouse, keyboard and screen add, nobody in the page sees.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import Page

SCRIPT = Path(__file__).with_suffix(".js")

Place = tuple[float, float, float]
"""When, ms, and where the robot was drawn: row and column, those of a cell's middle whole."""
Cell = tuple[int, int]


@dataclass(frozen=True)
class Sight:
    """What the onlooker says about one stop."""

    position_ms: float
    """Motion position on screen at the press."""
    pressed_ms: float
    """When the press was, since 1970."""
    handled_ms: float
    """From the press until a handler of it ran."""
    held_ms: float
    """From the press to the release, which a click comes with."""
    since_frame_ms: float
    """From the last frame drawn to the press."""
    dropped: int
    """Frames dropped in motion: gaps longer than one and a half times the usual one."""


def accompany(page: Page) -> None:
    """Look on at every page that is opened from here on."""
    page.add_init_script(path=SCRIPT)


def begin(page: Page) -> None:
    """Forget what was seen: a round begins."""
    page.evaluate("onlooker.begin()")


def sight(page: Page, playback: dict[str, Any]) -> Sight | None:
    """What was seen of the round that has been stopped; None if the robot crossed no border."""
    seen = page.evaluate("onlooker.seen()")
    press, release = seen["presses"][-1], seen["releases"][-1]
    middle = ((playback["rows"] - 1) / 2, (playback["cols"] - 1) / 2)
    drawn = [
        (time, row + middle[0], col + middle[1])
        for time, row, col in seen["places"][: press["places"]]
        if time <= press["at"]
    ]
    last_frame, usual_gap = _rhythm(seen["frames"][: press["frames"]])
    shown_until = min(press["at"], last_frame + usual_gap)
    position_ms = position(drawn, playback["path"], playback["step_ms"], shown_until)
    if position_ms is None:
        return None
    return Sight(
        position_ms=position_ms,
        pressed_ms=seen["origin"] + press["at"],
        handled_ms=press["handled"] - press["at"],
        held_ms=release["at"] - press["at"],
        since_frame_ms=press["at"] - last_frame,
        dropped=_dropped(seen["frames"], press["at"] - position_ms, press["at"]),
    )


def position(
    places: Iterable[Place], path: list[Cell], step_ms: float, time: float
) -> float | None:
    """Motion position at a time, ms, from the last border crossed; None if none was."""
    crossings = list(_crossings(places, path))
    if not crossings:
        return None
    step, crossed = crossings[-1]
    return (step + 0.5) * step_ms + time - crossed


def _crossings(places: Iterable[Place], path: list[Cell]) -> Iterator[tuple[int, float]]:
    """Steps in whose middle the robot was seen, each with its time; failed ones have none."""
    frames = pairwise(places)  # one pass: each crossing is looked for behind the one before
    for step, ((row, col), (next_row, next_col)) in enumerate(pairwise(path)):
        down, right = next_row - row, next_col - col
        if not down and not right:
            continue
        for (before, *origin), (after, *end) in frames:
            done, doing = (
                down * (place[0] - row) + right * (place[1] - col) for place in (origin, end)
            )
            if done < 0.5 <= doing:
                yield step, before + (after - before) * (0.5 - done) / (doing - done)
                break


def _rhythm(frames: list[float]) -> tuple[float, float]:
    """When the last of the frames drawn before a press was, and the usual gap between two."""
    return frames[-1], float(np.median(np.diff(frames)))


def _dropped(frames: list[float], first: float, last: float) -> int:
    """Late frames between two times, by the rhythm of those before."""
    times = np.array(frames)
    gaps, ends = np.diff(times), times[1:]
    usual = np.median(gaps[ends <= first])
    return int(np.sum(gaps[(ends > first) & (ends <= last)] > 1.5 * usual))
