"""Sessions: which participant a browser's token stands for, and which browser is the newest.

A session is `proven` when its browser has shown to be the participant's: by consenting or answering
in it, or by the very invitation they began with, if that names a session. Another browser that came
by the recruiter's id alone may go on, but not withdraw; nor see the code at the end, if that is of
another session.
"""

import secrets
from hashlib import sha256

from sqlalchemy import Connection

from app import repository
from app.errors import Moved, NoSession, OtherParticipant
from app.event_log import note
from app.repository import Record
from app.study import Study


def hashed(token: str | None) -> str:
    """What is stored of a session's token; without one, what no session has."""
    return sha256((token or "").encode()).hexdigest()


def participant_of(connection: Connection, token: str | None, page: str | None = None) -> Record:
    """The participant whose session this is; `page` names the one whose page is speaking.

    NoSession; Moved when a newer session exists; OtherParticipant when the page is another's.
    """
    return admitted(repository.participant_in_session(connection, hashed(token)), page)


def admitted(found: Record | None, page: str | None = None) -> Record:
    """What was found for a session's token, refused as in `participant_of`.

    Pages loaded before an upgrade do not say whose they are: `page` is None.
    """
    if found is None:
        raise NoSession
    if page not in (None, found.pseudonym):
        raise OtherParticipant
    if not found.current:
        raise Moved
    return found


def begin_session(
    connection: Connection,
    study: Study,
    participant: Record,
    what: str,
    user_agent: str,
    proven: bool,
) -> str:
    """Make a browser the participant's current one; returns its token and logs what led to it."""
    token = secrets.token_urlsafe(32)
    repository.begin_session(connection, participant.id, hashed(token), proven)
    note(connection, study, participant, what, {"user_agent": user_agent})
    return token


def prove(connection: Connection, participant: Record) -> None:
    """Note that the participant's current browser has answered."""
    if not participant.proven:
        repository.prove_session(connection, participant.id)
