"""Data quality: signs of how attentively somebody took part, each defined once."""

from collections.abc import Iterable, Sequence
from datetime import datetime

from app.errors import WrongStep
from app.steps import Happening, Step, advance
from policies import Scene, Stimulus, first_decision, scene_maze


def first_decision_s(scene: Scene, stimulus: Stimulus, step_ms: int) -> float:
    """Motion, s, until the robot of a stimulus had completed its first step by choice."""
    return first_decision(scene_maze(scene), stimulus.cells) * step_ms / 1000


def never_moved_pointer(moved: Sequence[bool | None]) -> bool | None:
    """Whether the pointer was moved in no round; None without rounds, or where they do not tell."""
    if any(moved):
        return False
    return True if moved and None not in moved else None


def alike(answers: Sequence[object]) -> bool | None:
    """Whether all answers are the same; None with fewer than two."""
    return len(set(answers)) == 1 if len(answers) > 1 else None


def times_s(
    consented_at: datetime, happened: Iterable[tuple[Happening, datetime]]
) -> dict[Step, float]:
    """Time at each step that was finished, s, breaks included, from what happened in order.

    A step during which the server's clock was set back has none; nor has any from where the log
    tells what cannot happen.
    """
    times: dict[Step, float] = {}
    step, since = Step.ABOUT_YOU, consented_at
    for happening, at in happened:
        try:
            next_step = advance(step, happening)
        except WrongStep:
            break
        if happening != Happening.BROKE and at >= since:
            times[step] = (at - since).total_seconds()
        step, since = next_step, at
    return times
