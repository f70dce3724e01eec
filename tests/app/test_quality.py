"""Signs of how somebody took part: each definition by hand, and its rules."""

from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.quality import alike, first_decision_s, never_moved_pointer, times_s
from app.steps import Happening, Step
from policies import Area, Scene, Stimulus

START = datetime(2025, 3, 1, 9, 30, tzinfo=UTC)
WHOLE_WAY = (
    Happening.DESCRIBED,
    Happening.INSTRUCTED,
    Happening.PASSED_CONTROL,
    Happening.ANSWERED_ALL,
)
MOVED = st.lists(st.sampled_from([True, False, None]), max_size=10)
GUESSES = st.lists(st.sampled_from("ABC"), max_size=10)


def after(*gaps_s):
    """Moments that lie so many seconds after the one before."""
    return [START + timedelta(seconds=sum(gaps_s[: i + 1])) for i in range(len(gaps_s))]


def happened(what, gaps_s):
    return list(zip(what, after(*gaps_s), strict=True))


@pytest.mark.parametrize(("step_ms", "seconds"), [(1000, 3.0), (400, 1.2)])
def test_the_first_decision_takes_the_steps_until_it_times_their_duration(step_ms, seconds):
    border = ((0, 0, 3, 0), (0, 2, 3, 2), (0, 0, 0, 2), (3, 0, 3, 2))
    # From cell 0 the one way leads to cell 1, and from there either on to 2 or down to 4.
    scene = Scene(2, 3, (*border, (0, 1, 1, 1)), (Area("A", 2), Area("B", 3)))
    stimulus = Stimulus("id", "s00", "optimal", "small", "A", cells=(0, 0, 1, 2))
    assert first_decision_s(scene, stimulus, step_ms) == seconds


@pytest.mark.parametrize(
    ("moved", "never"),
    [
        ([], None),
        ([None], None),
        ([False, False], True),
        ([False, True], False),
        ([None, True], False),
        ([False, None], None),
    ],
)
def test_the_pointer_was_never_moved_only_if_every_round_says_so(moved, never):
    assert never_moved_pointer(moved) is never


@given(MOVED, st.randoms(use_true_random=False))
def test_the_order_of_the_rounds_says_nothing_about_the_pointer(moved, dice):
    shuffled = dice.sample(moved, len(moved))
    assert never_moved_pointer(shuffled) is never_moved_pointer(moved)


@given(MOVED)
def test_one_move_of_the_pointer_is_enough(moved):
    assert never_moved_pointer([*moved, True]) is False


@pytest.mark.parametrize(
    ("answers", "same"),
    [([], None), (["A"], None), (["A", "A"], True), (["A", "B"], False), ([5, 5, 5, 4], False)],
)
def test_answers_are_alike_if_there_are_two_and_no_other(answers, same):
    assert alike(answers) is same


@given(GUESSES, st.sampled_from("ABC"))
def test_answers_once_different_stay_different(guesses, another):
    if alike(guesses) is False:
        assert alike([*guesses, another]) is False


def test_each_step_lasts_from_what_began_it_to_what_ended_it():
    times = times_s(START, happened(WHOLE_WAY, (60.5, 20, 45, 300)))
    assert times == {
        Step.ABOUT_YOU: 60.5,
        Step.INSTRUCTIONS: 20,
        Step.PRACTICE: 45,
        Step.TRIALS: 300,
    }


@given(st.lists(st.integers(0, 10**6), min_size=4, max_size=4), st.integers(0, 4))
def test_together_the_steps_last_from_the_consent_to_what_happened_last(gaps_s, so_far):
    way = happened(WHOLE_WAY, gaps_s)[:so_far]
    times = times_s(START, way)
    last = way[-1][1] if way else START
    assert len(times) == so_far
    assert sum(times.values()) == (last - START).total_seconds()


def test_a_step_during_which_the_clock_was_set_back_has_no_time():
    times = times_s(START, happened(WHOLE_WAY, (60, -3600, 45, 300)))
    assert times == {Step.ABOUT_YOU: 60, Step.PRACTICE: 45, Step.TRIALS: 300}


def test_a_log_that_tells_what_cannot_happen_is_followed_until_there():
    way = (Happening.DESCRIBED, Happening.PASSED_CONTROL, Happening.INSTRUCTED)
    assert times_s(START, happened(way, (10, 20, 30))) == {Step.ABOUT_YOU: 10}


def test_the_practice_ends_with_the_control_question_failed_too():
    way = (Happening.DESCRIBED, Happening.INSTRUCTED, Happening.FAILED_CONTROL)
    assert times_s(START, happened(way, (10, 20, 30)))[Step.PRACTICE] == 30


def test_a_step_that_was_broken_off_has_no_end():
    way = (Happening.DESCRIBED, Happening.BROKE)
    assert times_s(START, happened(way, (10, 20))) == {Step.ABOUT_YOU: 10}
