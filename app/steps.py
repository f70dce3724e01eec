"""The participant's steps: a state machine without web or SQL."""

from enum import StrEnum

from app.errors import WrongStep

CONTROL_TRIES = 2


class Step(StrEnum):
    """Where a participant is; before consent there is no participant."""

    ABOUT_YOU = "about_you"
    INSTRUCTIONS = "instructions"
    PRACTICE = "practice"
    TRIALS = "trials"
    COMPLETED = "completed"
    SCREENED_OUT = "screened_out"
    FAILED = "failed"
    WITHDRAWN = "withdrawn"


class Happening(StrEnum):
    """What moves a participant from one step to another."""

    DESCRIBED = "described"
    INSTRUCTED = "instructed"
    PASSED_CONTROL = "passed_control"
    FAILED_CONTROL = "failed_control"
    ANSWERED_ALL = "answered_all"
    BROKE = "broke"
    WITHDREW = "withdrew"


class Phase(StrEnum):
    """Where a trial is, in order; once answered, the next trial is ready."""

    READY = "ready"
    MOVING = "moving"
    ASKING = "asking"


ENDINGS = frozenset({Step.COMPLETED, Step.SCREENED_OUT, Step.FAILED, Step.WITHDRAWN})

ON_THE_WAY = (Step.ABOUT_YOU, Step.INSTRUCTIONS, Step.PRACTICE, Step.TRIALS)

_NEXT: dict[tuple[Step, Happening], Step] = {
    (Step.ABOUT_YOU, Happening.DESCRIBED): Step.INSTRUCTIONS,
    (Step.INSTRUCTIONS, Happening.INSTRUCTED): Step.PRACTICE,
    (Step.PRACTICE, Happening.PASSED_CONTROL): Step.TRIALS,
    (Step.PRACTICE, Happening.FAILED_CONTROL): Step.SCREENED_OUT,
    (Step.TRIALS, Happening.ANSWERED_ALL): Step.COMPLETED,
    **{(step, Happening.BROKE): Step.FAILED for step in ON_THE_WAY},
    **{(step, Happening.WITHDREW): Step.WITHDRAWN for step in Step if step != Step.WITHDRAWN},
}


def advance(step: Step, happening: Happening) -> Step:
    """The step after a happening; WrongStep when it cannot happen there."""
    try:
        return _NEXT[step, happening]
    except KeyError:
        raise WrongStep(f"{happening.value!r} cannot happen at step {step.value!r}.") from None


def may_withdraw(step: Step, study_open: bool) -> bool:
    """Whoever is on the way can withdraw at any time, whoever has ended while the study is open."""
    return step != Step.WITHDRAWN and (study_open or step not in ENDINGS)


def judge_control(right: bool, tries: int) -> Happening | None:
    """What an answer to the control question means, `tries` counting it; None: ask once more."""
    if right:
        return Happening.PASSED_CONTROL
    return Happening.FAILED_CONTROL if tries >= CONTROL_TRIES else None
