"""What the trial page sends, as pydantic models.

What no page of ours can send is refused. What an honest page can send although it cannot be (times
of a clock that ran wild, an event that this version does not know) is mended and noted instead:
refused, it would be sent again for ever, and its participant would be stuck.
"""

import json
from math import inf, isnan, nan
from typing import Annotated, Any, Literal, TypeVar

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PrivateAttr,
    ValidationError,
    ValidationInfo,
)

from analysis import POINTER_TYPES

MOST_MS = 1e11
"""Three years: no page is open for longer."""
MOST_IN_MESSAGE = 200
LONGEST_DETAILS = 1000
"""Characters of an event's details as JSON; the longest of ours has some 150."""


def _within(low: float, high: float) -> BeforeValidator:
    """Take a number that cannot be for the nearest that can; the context learns what came."""

    def clamp(value: object, info: ValidationInfo) -> object:
        if value is not None and (isinstance(value, bool) or not isinstance(value, int | float)):
            return value
        # What JavaScript has no number for arrives as null.
        number = nan if value is None else _as_float(value)
        there = low if isnan(number) else min(max(number, low), high)
        if there == number:
            return value
        _note(info, str(info.field_name), str(None if value is None else number))
        return there

    return BeforeValidator(clamp)


def _as_float(number: int | float) -> float:
    """The number, infinite where it has more digits than any float."""
    try:
        return float(number)
    except OverflowError:
        return inf if number > 0 else -inf


def _whole(value: object) -> object:
    return round(value) if isinstance(value, float) else value


def _note(info: ValidationInfo, field: str, came: object) -> None:
    if info.context is not None:
        info.context[field] = came


Key = Annotated[str, Field(min_length=8, max_length=64, pattern=r"^[A-Za-z0-9-]+$")]
Milliseconds = Annotated[float, _within(0, MOST_MS)]
Count = Annotated[int, BeforeValidator(_whole), _within(0, 1e6)]
Pixels = Annotated[int, BeforeValidator(_whole), _within(0, 1e5)]
EventType = Literal[
    "shown",
    "played",
    "stopped",
    "hidden",
    "visible",
    "focus_lost",
    "focus_gained",
    "resized",
    "answered",
    "retried",
    "interrupted",
    "continued",
    "second_tab",
]


def _short_json(details: object) -> object:
    """Leave out details too long to keep, or with NaN, which no other reader of JSON takes."""
    try:
        short = len(json.dumps(details, allow_nan=False)) <= LONGEST_DETAILS
    except ValueError:
        short = False
    return details if short else {"left_out": True}


def pointer_type(sent: Any) -> str | None:
    """One of `POINTER_TYPES`, whatever a page sent; None where it sent none."""
    return sent if sent is None or sent in POINTER_TYPES else "other"


PointerType = Annotated[str | None, BeforeValidator(pointer_type)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class LoggedEvent(_Strict):
    """Something that happened on the page, by the page's monotonic clock."""

    type: EventType
    client_time_ms: Milliseconds
    details: Annotated[dict[str, Any], BeforeValidator(_short_json)] = {}


def _known_events(events: object, info: ValidationInfo) -> object:
    """Keep the events that can be logged: one that cannot holds back no answer."""
    if not isinstance(events, list):
        return events
    kept = []
    for event in events[:MOST_IN_MESSAGE]:
        try:
            kept.append(LoggedEvent.model_validate(event, context=info.context))
        except ValidationError:
            continue
    if len(kept) < len(events):
        _note(info, "events_left_out", len(events) - len(kept))
    return kept


class Message(_Strict):
    """Any message of the trial page; `key` stays the same however often it is delivered.

    `participant` says whose page it is: the browser's session may be another one's by now.
    `waited_ms` is how long the page has kept it. Pages loaded before an upgrade say neither.
    """

    key: Key
    participant: Annotated[str, Field(max_length=64)] | None = None
    waited_ms: Milliseconds | None = None
    events: Annotated[list[LoggedEvent], BeforeValidator(_known_events)] = []
    _mended: dict[str, Any] = PrivateAttr(default_factory=dict)

    @property
    def mended(self) -> dict[str, Any]:
        """What came in the place of each value that could not be, by its field."""
        return self._mended

    @property
    def clamped(self) -> bool:
        """Whether a time was one that cannot be."""
        return any(field.endswith("_ms") for field in self._mended)


ENVELOPE = set(Message.model_fields)
"""What is said of a message itself, not of a trial."""

M = TypeVar("M", bound=Message)


def read_message(model: type[M], body: bytes) -> M:
    """A message of the page, mended where it must be; ValidationError if it is none of ours."""
    mended: dict[str, Any] = {}
    message = model.model_validate_json(body, context=mended)
    message._mended = mended
    return message


class Device(_Strict):
    """The browser as the page sees it."""

    viewport_width: Pixels
    viewport_height: Pixels
    pixel_ratio: Annotated[float, _within(0.01, 100)]
    refresh_rate_hz: Annotated[float, _within(0.01, 10_000)] | None = None
    pointer_type: PointerType = None
    reduced_motion: bool


class Played(Message):
    """The first frame in motion was drawn; `ticket` as it came with the trial."""

    ticket: Annotated[str, Field(max_length=64)]
    device: Device


class Stopped(Message):
    """The motion was stopped, or ran to its end.

    `stop_time_ms` is where the motion was at the press by the page's clock, whether or not it was
    drawn: `last_frame_ms` is the position drawn last, `frame_interval_ms` the usual time to the
    next frame; `played_took_ms` how long it took until the server had acknowledged that the motion
    began. Pages loaded before an upgrade do not tell those.
    """

    stop_time_ms: Milliseconds
    last_frame_ms: Milliseconds | None = None
    frame_interval_ms: Milliseconds | None = None
    played_took_ms: Milliseconds | None = None
    reached_end: bool
    pauses: Count
    paused_ms: Milliseconds
    focus_losses: Count
    frames_dropped: Count
    reduced_motion: bool


class Answered(Message):
    """Area and confidence were chosen, having stopped at `stop_time_ms`.

    A page that was loaded before an upgrade does not say whether the pointer moved.
    """

    stop_time_ms: Milliseconds
    guess: Annotated[str, Field(pattern=r"^[A-Z]$")]
    confidence: Annotated[int, Field(ge=1, le=7)]
    guess_latency_ms: Milliseconds
    confidence_latency_ms: Milliseconds
    pointer_moved: bool | None = None


class Logged(Message):
    """Events that no answer carries, sent when somebody leaves the page."""

    trial_index: int | None = None
    position_ms: Milliseconds | None = None
