"""The log: what the server did, and what the page reports, each event once and for good.

Nobody's log grows without end: what comes beyond `MOST_EVENTS` is left out, and this is noted.
"""

import secrets
from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import Connection

from app import VERSION, repository
from app.repository import Record
from app.schemas import Message
from app.study import Study

PLAYED_ELSEWHERE = "played_elsewhere"
"""Of a trial whose animation another browser of the participant had begun to play."""

CAME_BACK = "came_back"
"""They went on in another browser."""

MOST_EVENTS = 5000
"""Of one participant's pages; whoever takes part has some hundred."""
MOST_NOTES = 1000
"""Room that is left for what the server itself has to say."""


def note(
    connection: Connection,
    study: Study,
    participant: Record,
    what: str,
    details: Mapping[str, object],
    index: int | None = None,
    key: str | None = None,
) -> None:
    """Log something that the server did or noticed; of a message by its `key`, once for all."""
    room = MOST_EVENTS + MOST_NOTES - repository.count_events(connection, participant.id)
    if room > 0:
        event = _event(what, details, index)
        _append(connection, study, participant, key or secrets.token_hex(8), [event])


def log_message(
    connection: Connection,
    study: Study,
    participant: Record,
    index: int | None,
    stimulus: str | None,
    message: Message,
) -> None:
    """Log the events of a message from the page, and what of it had to be mended.

    Delivered again, it adds nothing.
    """
    rows = [
        {
            **_event(event.type, event.details, index),
            "client_time_ms": event.client_time_ms,
            "stimulus": stimulus,
        }
        for event in message.events
    ]
    if message.mended:
        rows.append(_event("mended", message.mended, index))
    room = MOST_EVENTS - repository.count_events(connection, participant.id) if rows else 0
    if room <= 0:
        return
    if len(rows) >= room:
        rows = [*rows[: room - 1], _event("log_full", {"left_out_from_here": True}, None)]
    _append(connection, study, participant, message.key, rows)


def _event(what: str, details: Mapping[str, object], index: int | None) -> dict[str, Any]:
    return {
        "type": what,
        "details": details,
        "trial_index": index,
        "client_time_ms": None,
        "stimulus": None,
    }


def _append(
    connection: Connection,
    study: Study,
    participant: Record,
    key: str,
    rows: Sequence[Mapping[str, Any]],
) -> None:
    shared = {
        "participant_id": participant.id,
        "message_key": key,
        "server_time": repository.now(),
        "study_hash": study.hash,
        "app_version": VERSION,
    }
    repository.log(
        connection, [{**row, **shared, "ordinal": ordinal} for ordinal, row in enumerate(rows)]
    )
