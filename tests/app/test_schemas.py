"""What the trial page sends: what cannot be is mended and noted, or else refused."""

import json
from math import inf, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from app.schemas import (
    LONGEST_DETAILS,
    MOST_IN_MESSAGE,
    MOST_MS,
    Answered,
    Logged,
    Played,
    Stopped,
    read_message,
)
from tests import messages

DAY_MS = 24 * 3600 * 1000
ANY_NUMBER = st.floats() | st.integers() | st.integers(-(10**400), 10**400) | st.none()


def read(model, body):
    return read_message(model, json.dumps(body).encode())


def test_what_can_be_is_left_as_it_came():
    message = read(Stopped, messages.stopped(4321.5))
    assert (message.stop_time_ms, message.mended) == (4321.5, {})


def test_twelve_days_away_are_twelve_days():
    message = read(Stopped, {**messages.stopped(100), "paused_ms": 12 * DAY_MS})
    assert (message.paused_ms, message.mended) == (12 * DAY_MS, {})


@pytest.mark.parametrize(
    ("came", "kept", "noted"),
    [
        (1e18, MOST_MS, "1e+18"),
        (-3, 0, "-3.0"),
        (nan, 0, "nan"),
        (inf, MOST_MS, "inf"),
        (-inf, 0, "-inf"),
        (None, 0, "None"),
        (10**400, MOST_MS, "inf"),
        (-(10**400), 0, "-inf"),
    ],
    ids=lambda value: str(value)[:8],
)
def test_a_time_that_cannot_be_is_taken_for_the_nearest_that_can(came, kept, noted):
    message = read(Stopped, {**messages.stopped(100), "paused_ms": came})
    assert (message.paused_ms, message.mended) == (kept, {"paused_ms": noted})


@given(ANY_NUMBER, ANY_NUMBER, ANY_NUMBER)
def test_no_number_of_a_page_makes_its_message_refused(time, count, pixels):
    stop = {**messages.stopped(0), "stop_time_ms": time, "pauses": count, "waited_ms": time}
    read(Stopped, {**stop, "last_frame_ms": time, "events": [messages.event("shown", time)]})
    latencies = {"guess_latency_ms": time, "confidence_latency_ms": time}
    read(Answered, {**messages.answered("A", 0), **latencies, "stop_time_ms": time})
    begun = messages.played("ticket")
    sizes = {"viewport_width": pixels, "pixel_ratio": pixels, "refresh_rate_hz": pixels}
    read(Played, {**begun, "device": {**begun["device"], **sizes}})
    read(Logged, {"key": messages.key(), "position_ms": time})


@pytest.mark.parametrize(
    "odd",
    [
        {"type": "of-a-later-version", "client_time_ms": 1},
        {"type": "shown"},
        {"type": "shown", "client_time_ms": "soon"},
        {"type": "shown", "client_time_ms": 1, "more": True},
        "shown",
    ],
)
def test_an_event_that_cannot_be_logged_holds_nothing_back(odd):
    body = messages.answered("A", 0)
    message = read(Answered, {**body, "events": [odd, messages.event("answered")]})
    assert [event.type for event in message.events] == ["answered"]
    assert message.mended == {"events_left_out": 1}


@pytest.mark.parametrize("details", [{"width": nan}, {"text": "x" * LONGEST_DETAILS}])
def test_details_that_cannot_be_kept_are_left_out_of_their_event(details):
    body = {"key": messages.key(), "events": [messages.event("resized", **details)]}
    (event,) = read(Logged, body).events
    assert (event.type, event.details) == ("resized", {"left_out": True})


def test_more_events_than_a_message_holds_are_left_out():
    events = [messages.event("hidden")] * (MOST_IN_MESSAGE + 3)
    message = read(Logged, {"key": messages.key(), "events": events})
    assert len(message.events) == MOST_IN_MESSAGE
    assert message.mended == {"events_left_out": 3}


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"stop_time_ms": "soon"}, "stop_time_ms"),
        ({"key": "short"}, "key"),
        ({"reached_end": None}, "reached_end"),
        ({"events": "none"}, "events"),
        ({"goal": "A"}, "goal"),
    ],
)
def test_what_no_page_of_ours_sends_is_refused(changes, field):
    with pytest.raises(ValidationError) as refused:
        read(Stopped, {**messages.stopped(100), **changes})
    assert refused.value.errors()[0]["loc"][0] == field
