"""Sessions: which participant a browser's token stands for, and which browser is the newest."""

import secrets
from hashlib import sha256

from sqlalchemy import Connection

from app import repository
from app.errors import Moved, NoSession
from app.event_log import note
from app.repository import Record
from app.study import Study


def hashed(token: str | None) -> str:
    """What is stored of a session's token; without one, what no session has."""
    return sha256((token or "").encode()).hexdigest()


def participant_of(connection: Connection, token: str | None) -> Record:
    """The participant whose session this is; NoSession, or Moved when a newer one exists."""
    return admitted(repository.participant_in_session(connection, hashed(token)))


def admitted(found: Record | None) -> Record:
    """What was found for a session's token, if it is a participant's current session."""
    if found is None:
        raise NoSession
    if not found.current:
        raise Moved
    return found


def begin_session(
    connection: Connection, study: Study, participant: Record, what: str, user_agent: str
) -> str:
    """Make a browser the participant's current one; returns its token and logs what led to it."""
    token = secrets.token_urlsafe(32)
    repository.begin_session(connection, participant.id, hashed(token))
    note(connection, study, participant, what, {"user_agent": user_agent})
    return token
