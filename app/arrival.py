"""Arrival: the invitation link, coming back by it, and consent.

Each function takes the connection of an open transaction; `database.write` commits it before
the reply.
"""

import secrets
from collections.abc import Mapping
from dataclasses import dataclass

from sqlalchemy import Connection

from app import VERSION, books, repository
from app.errors import InvalidInput, Moved, NoSession, WrongStep
from app.sessions import begin_session, hashed
from app.steps import Step
from app.study import Study

LONGEST_ID = 100
STREAMS = ("participant", "preview", "simulated")
"""Real participants and pilots are dealt from streams of their own and never mixed."""

_LINK_IDS = ("PROLIFIC_PID", "STUDY_ID", "SESSION_ID")


@dataclass(frozen=True)
class Link:
    """What an invitation link says: the recruiter's ids, and whether this is a pilot."""

    recruiter_id: str | None = None
    recruiter_study: str | None = None
    recruiter_session: str | None = None
    stream: str = STREAMS[0]

    @classmethod
    def read(cls, values: Mapping[str, str]) -> "Link":
        """Read a link's query or the consent form's hidden fields; InvalidInput if impossible."""
        ids = [values.get(name) or None for name in _LINK_IDS]
        for name, value in zip(_LINK_IDS, ids, strict=True):
            if value and (len(value) > LONGEST_ID or not value.isprintable()):
                raise InvalidInput(
                    f"{name}: expected at most {LONGEST_ID} printable characters in the link."
                )
        stream = next((pilot for pilot in STREAMS[1:] if values.get(pilot)), STREAMS[0])
        return cls(ids[0], ids[1], ids[2], stream)

    def fields(self) -> dict[str, str]:
        """The same as hidden fields of the consent form."""
        ids = (self.recruiter_id, self.recruiter_study, self.recruiter_session)
        fields = {name: value for name, value in zip(_LINK_IDS, ids, strict=True) if value}
        return fields if self.stream == STREAMS[0] else {**fields, self.stream: "1"}


@dataclass(frozen=True)
class Known:
    """Somebody who opened the link again; `moves`: in a browser that has no session of theirs."""

    step: Step
    moves: bool


def find(connection: Connection, link: Link, token: str | None) -> Known | None:
    """Who opens a link, by the recruiter's id or, without one, by the browser's session."""
    here = repository.participant_in_session(connection, hashed(token))
    if not link.recruiter_id:
        if here and not here.current:
            raise Moved
        return Known(Step(here.step), moves=False) if here else None
    known = repository.participant_recruited(connection, link.recruiter_id)
    if known is None:
        return None
    stays = here is not None and here.current and here.id == known.id
    return Known(Step(known.step), moves=not stays)


def come_back(connection: Connection, link: Link) -> str:
    """Move the session of somebody known by a recruiter's id to this browser."""
    known = link.recruiter_id and repository.participant_recruited(connection, link.recruiter_id)
    if not known:
        raise NoSession
    return begin_session(connection, known, "came_back")


def consent(connection: Connection, study: Study, arrival: str, link: Link, user_agent: str) -> str:
    """Make the participant, once for each recruiter's id and each showing of the form.

    Returns the token of their session.
    """
    known = repository.participant_arrived(connection, arrival) or (
        link.recruiter_id and repository.participant_recruited(connection, link.recruiter_id)
    )
    if known:
        return begin_session(connection, known, "came_back")
    if not study.settings.study_open:
        raise WrongStep("This study is closed; thank you for your interest.")
    participant = repository.add_participant(
        connection,
        pseudonym=secrets.token_hex(6),
        arrival=arrival,
        stream=link.stream,
        step=Step.ABOUT_YOU,
        study_hash=study.hash,
        app_version=VERSION,
        consent_hash=study.consent_hash,
        consented_at=repository.now(),
        user_agent=user_agent,
    )
    if link.recruiter_id:
        repository.add_recruit(
            connection,
            participant.id,
            link.recruiter_id,
            link.recruiter_study,
            link.recruiter_session,
        )
    return begin_session(connection, participant, "consented")


def decline(connection: Connection) -> None:
    """Count somebody who gave no consent; nothing else is kept of them."""
    books.tally(connection, "arrived, no consent")
