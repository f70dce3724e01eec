"""What the trial page sends, as pydantic models that refuse whatever cannot be."""

import json
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field

Key = Annotated[str, Field(min_length=8, max_length=64, pattern=r"^[A-Za-z0-9-]+$")]
Count = Annotated[int, Field(ge=0, le=1_000_000)]
Milliseconds = Annotated[float, Field(ge=0, le=1e9, allow_inf_nan=False)]
Pixels = Annotated[int, Field(ge=0, le=100_000)]
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


POINTER_TYPES = ("mouse", "touch", "pen", "keyboard", "other")


def pointer_type(sent: Any) -> str | None:
    """One of `POINTER_TYPES`, whatever a page sent; None where it sent none."""
    return sent if sent is None or sent in POINTER_TYPES else "other"


PointerType = Annotated[str | None, BeforeValidator(pointer_type)]


def _json(details: dict[str, Any]) -> dict[str, Any]:
    """Refuse NaN and infinity, which the parser lets pass and no other reader of JSON does."""
    json.dumps(details, allow_nan=False)
    return details


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class LoggedEvent(_Strict):
    """Something that happened on the page, by the page's monotonic clock."""

    type: EventType
    client_time_ms: Milliseconds
    details: Annotated[dict[str, Any], AfterValidator(_json)] = {}


class Message(_Strict):
    """Any message of the trial page; `key` stays the same however often it is delivered."""

    key: Key
    events: Annotated[list[LoggedEvent], Field(max_length=200)] = []


class Device(_Strict):
    """The browser as the page sees it."""

    viewport_width: Pixels
    viewport_height: Pixels
    pixel_ratio: Annotated[float, Field(gt=0, le=100, allow_inf_nan=False)]
    refresh_rate_hz: Annotated[float, Field(gt=0, le=10_000, allow_inf_nan=False)] | None = None
    pointer_type: PointerType = None
    reduced_motion: bool


class Played(Message):
    """The first frame in motion was drawn; `ticket` as it came with the trial."""

    ticket: Annotated[str, Field(max_length=64)]
    device: Device


class Stopped(Message):
    """The motion was stopped, or ran to its end."""

    stop_time_ms: Milliseconds
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

    trial_index: Annotated[int, Field(ge=1, le=1000)] | None = None
    position_ms: Milliseconds | None = None
