"""The log: what the server did, and what the page reports, each event once and for good."""

import secrets
from collections.abc import Mapping

from sqlalchemy import Connection

from app import VERSION, repository
from app.repository import Record
from app.schemas import Message
from app.study import Study


def note(
    connection: Connection,
    study: Study,
    participant: Record,
    what: str,
    details: Mapping[str, object],
) -> None:
    """Log something that happened on the server."""
    repository.log(
        connection,
        [
            {
                "participant_id": participant.id,
                "message_key": secrets.token_hex(8),
                "ordinal": 0,
                "type": what,
                "server_time": repository.now(),
                "details": details,
                "study_hash": study.hash,
                "app_version": VERSION,
            }
        ],
    )


def log_message(
    connection: Connection,
    study: Study,
    participant: Record,
    index: int | None,
    stimulus: str | None,
    message: Message,
) -> None:
    """Log the events of a message from the page; delivered again, it adds nothing."""
    server_time = repository.now()
    repository.log(
        connection,
        [
            {
                "participant_id": participant.id,
                "message_key": message.key,
                "ordinal": ordinal,
                "trial_index": index,
                "type": event.type,
                "server_time": server_time,
                "client_time_ms": event.client_time_ms,
                "details": event.details,
                "stimulus": stimulus,
                "study_hash": study.hash,
                "app_version": VERSION,
            }
            for ordinal, event in enumerate(message.events)
        ],
    )
