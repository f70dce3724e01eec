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

MOST_EVENTS = 5000
"""Of one participant; whoever takes part has some hundred."""


def note(
    connection: Connection,
    study: Study,
    participant: Record,
    what: str,
    details: Mapping[str, object],
    index: int | None = None,
) -> None:
    """Log something that the server did or noticed."""
    _append(connection, study, participant, secrets.token_hex(8), [_event(what, details, index)])


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
    if rows:
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
    room = MOST_EVENTS - repository.count_events(connection, participant.id)
    if room <= 0:
        return
    if len(rows) >= room:
        rows = [*rows[: room - 1], _event("log_full", {"left_out_from_here": True}, None)]
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
