"""Whether times can be: by the server's clock alone, whatever a page claims."""

from datetime import UTC, datetime, timedelta
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.trial_times import (
    TOLERANCE_S,
    TrialTimes,
    are_impossible,
    is_impossible,
    server_stretch_s,
)

START = datetime(2025, 3, 1, 9, 30, tzinfo=UTC)
LEAD_IN_S = 1.5
SHORT = st.floats(0, 60)
ANY_WAIT_MS = st.none() | st.floats(0, 1e9)


def trial(since=0.0, played=5.0, stopped=15.0, stop_s=9.9, waited_ms=0.0, seen_ms=0.0):
    """A trial by seconds of the server's clock since `START`; answered a second after the stop."""
    return TrialTimes(
        available_since=START + timedelta(seconds=since),
        played_at=START + timedelta(seconds=played),
        stopped_at=START + timedelta(seconds=stopped),
        answered_at=START + timedelta(seconds=stopped + 1),
        lead_in_ms=LEAD_IN_S * 1000,
        played_waited_ms=waited_ms,
        seen_ms=seen_ms,
        stop_time_ms=stop_s * 1000,
    )


@pytest.mark.parametrize(
    ("facts", "stretch_s"),
    [
        ({}, 10.0),
        ({"waited_ms": 3000}, 13.0),
        ({"waited_ms": 3500}, 13.5),
        ({"waited_ms": 3501}, 13.5),  # nobody had the animation before
        ({"waited_ms": None}, 13.5),
        ({"played": 0.1, "stopped": 0.2, "waited_ms": 9000}, 0.0),
        ({"played": 15.1}, None),
        ({"since": 5.1}, None),
    ],
)
def test_the_stretch_goes_from_when_the_motion_can_have_begun_to_the_stop(facts, stretch_s):
    found = server_stretch_s(trial(**facts))
    assert found == (None if stretch_s is None else pytest.approx(stretch_s))


@pytest.mark.parametrize(
    ("facts", "impossible"),
    [
        ({"stop_s": 12.0}, False),
        ({"stop_s": 12.001}, True),
        ({"stop_s": 12.001, "waited_ms": 1}, False),
        ({"stop_s": 4.0, "seen_ms": 4001.0}, False),
        ({"stop_s": 4.0, "seen_ms": 4001.1}, True),
        ({"stop_s": 4.0, "seen_ms": 4001.1, "played": 15.1}, True),
        ({"stop_s": 4000.0, "played": 15.1}, None),
    ],
)
def test_a_stop_is_impossible_beyond_the_stretch_or_before_what_was_seen(facts, impossible):
    assert is_impossible(trial(**facts)) is impossible


@given(SHORT, SHORT, SHORT, ANY_WAIT_MS)
def test_no_claim_of_waiting_hides_more_motion_than_there_was_time(before, between, excess, waited):
    stop_s = before + between - LEAD_IN_S + TOLERANCE_S + 0.001 + excess
    claimed = trial(
        played=before, stopped=before + between, stop_s=max(0.0, stop_s), waited_ms=waited
    )
    if stop_s >= 0:
        assert is_impossible(claimed) is True


@given(SHORT, SHORT, SHORT, st.floats(0, 3600), st.floats(-TOLERANCE_S, 60))
def test_an_honest_page_is_never_flagged_however_long_it_was_offline(
    thought, motion, pause, offline, slower
):
    """`slower` is by how much longer the stop travelled than the message before it."""
    began = thought + LEAD_IN_S
    played = began + offline
    stopped = max(began + motion + pause, played) + slower
    if stopped >= played:
        honest = trial(
            played=played, stopped=stopped, stop_s=max(0.0, motion - 0.001), waited_ms=offline * 1e3
        )
        assert is_impossible(honest) is False


@given(st.lists(st.tuples(SHORT, SHORT, SHORT), min_size=1, max_size=10))
def test_an_honest_participant_is_not_flagged_for_all_trials_together(way):
    trials, now = [], 0.0
    for thought, motion, answering in way:
        began = now + thought + LEAD_IN_S
        stopped = began + motion
        trials.append(trial(now, began, stopped, stop_s=motion))
        now = stopped + 1 + answering
    assert are_impossible(trials) is False


def by_a_program(stop_s, each_s=0.02):
    """Ten trials, each played, stopped and answered within so many seconds."""
    at = [START + timedelta(seconds=each_s * number) for number in range(11)]
    return [
        TrialTimes(since, since, then, then, LEAD_IN_S * 1000, 0.0, 0.0, stop_s * 1000)
        for since, then in pairwise(at)
    ]


def test_trials_of_which_each_could_be_are_found_by_their_sum():
    trials = by_a_program(stop_s=0.4)
    assert [is_impossible(each) for each in trials] == [False] * 10
    assert are_impossible(trials) is True
    assert are_impossible(trials[:1]) is False


@given(SHORT, st.floats(0, 10))
def test_no_ten_trials_together_claim_more_than_the_tolerance(excess, each_s):
    most_s = each_s - LEAD_IN_S + TOLERANCE_S / 10
    assert are_impossible(by_a_program(max(0.0, most_s) + 0.001 + excess, each_s)) is True


def test_a_clock_that_was_set_back_judges_nobody():
    back = trial(since=0, played=5, stopped=-3540)
    later = trial(since=-3539, played=-3530, stopped=-3520, stop_s=9)
    assert are_impossible([back]) is None
    assert are_impossible([back, later]) is False
    # An hour later by a clock that went back: the sum says nothing.
    assert are_impossible([trial(), trial(since=14, played=14, stopped=14.5, stop_s=0.4)]) is False


def test_without_trials_or_without_the_time_they_were_dealt_nothing_is_judged():
    undealt = TrialTimes(None, START, START, START, 0, 0.0, 0, 60_000)
    assert are_impossible([]) is None
    assert server_stretch_s(undealt) is None
    assert are_impossible([undealt]) is None
