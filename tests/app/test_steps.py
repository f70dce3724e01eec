"""The participant's steps."""

import pytest

from app.errors import WrongStep
from app.steps import ENDINGS, Happening, Step, advance, judge_control


def test_the_way_through_the_study_is_one_line():
    step = Step.ABOUT_YOU
    for happening in (
        Happening.DESCRIBED,
        Happening.INSTRUCTED,
        Happening.PASSED_CONTROL,
        Happening.ANSWERED_ALL,
    ):
        step = advance(step, happening)
    assert step == Step.COMPLETED


@pytest.mark.parametrize("step", sorted(ENDINGS - {Step.WITHDRAWN}))
def test_from_an_ending_only_withdrawal_leads_on(step):
    possible = []
    for happening in Happening:
        try:
            possible.append((happening, advance(step, happening)))
        except WrongStep:
            continue
    assert possible == [(Happening.WITHDREW, Step.WITHDRAWN)]


@pytest.mark.parametrize("happening", list(Happening))
def test_nothing_leads_out_of_withdrawal(happening):
    with pytest.raises(WrongStep):
        advance(Step.WITHDRAWN, happening)


def test_no_step_can_be_skipped():
    with pytest.raises(WrongStep, match="'answered_all' cannot happen at step 'practice'"):
        advance(Step.PRACTICE, Happening.ANSWERED_ALL)


@pytest.mark.parametrize("step", [Step.ABOUT_YOU, Step.INSTRUCTIONS, Step.PRACTICE, Step.TRIALS])
def test_every_step_can_fail_technically(step):
    assert advance(step, Happening.BROKE) == Step.FAILED


@pytest.mark.parametrize(
    ("right", "tries", "outcome"),
    [
        (True, 1, Happening.PASSED_CONTROL),
        (True, 2, Happening.PASSED_CONTROL),
        (False, 1, None),
        (False, 2, Happening.FAILED_CONTROL),
    ],
)
def test_the_control_question_gives_two_tries(right, tries, outcome):
    assert judge_control(right, tries) == outcome
