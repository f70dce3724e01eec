"""Coming, going and everything between but the trials: one function per thing that happens.

Each takes the connection of an open transaction; `database.write` commits it before the reply.
"""

import os
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import timedelta
from hashlib import sha256
from pathlib import Path

from sqlalchemy import Connection

from app import VERSION, repository
from app.assignment import deal_block
from app.errors import DatabaseMismatch, InvalidInput, Moved, NoSession, WrongStep
from app.questions import CONTROL_RIGHT
from app.repository import Record
from app.steps import ENDINGS, Happening, Step, advance, judge_control
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


def open_books(connection: Connection, study: Study) -> None:
    """Note the study's definition; DatabaseMismatch if the places come from another pool."""
    found = repository.pool_in_use(connection)
    if found not in (None, study.pool.hash):
        raise DatabaseMismatch(
            f"expected a database dealt from stimulus pool {study.pool.hash[:12]}, found "
            f"{found[:12] if found else found}; name a new file in GOALGUESS_DATABASE_URL"
        )
    repository.register_study(connection, study.hash, study.definition, study.pool.hash)
    seed = study.settings.seed
    repository.draw_from(
        connection,
        seed=secrets.randbits(32) if seed is None else seed,
        block_size=study.settings.block_size,
    )


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
    return _begin_session(connection, known, "came_back")


def consent(connection: Connection, study: Study, arrival: str, link: Link, user_agent: str) -> str:
    """Make the participant, once for each recruiter's id and each showing of the form.

    Returns the token of their session.
    """
    known = repository.participant_arrived(connection, arrival) or (
        link.recruiter_id and repository.participant_recruited(connection, link.recruiter_id)
    )
    if known:
        return _begin_session(connection, known, "came_back")
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
    return _begin_session(connection, participant, "consented")


def decline(connection: Connection) -> None:
    """Count somebody who gave no consent; nothing else is kept of them."""
    repository.tally(connection, "arrived, no consent")


def describe(
    connection: Connection, token: str | None, answers: Mapping[str, str | int | None]
) -> None:
    """Keep what a participant said about themselves and go on."""
    participant = participant_of(connection, token)
    _go_on(connection, participant, Happening.DESCRIBED)
    repository.add_demographics(connection, participant.id, answers)


def finish_instructions(connection: Connection, token: str | None) -> None:
    """Go on from the instructions to the practice."""
    _go_on(connection, participant_of(connection, token), Happening.INSTRUCTED)


def answer_control(
    connection: Connection, study: Study, token: str | None, answer: str | int | None
) -> Step:
    """Judge the control question; who passes is dealt a place in the same transaction.

    Returns the step that follows; a question that has been settled is not judged again.
    """
    participant = participant_of(connection, token)
    if participant.step != Step.PRACTICE:
        return Step(participant.step)
    tries = participant.control_tries + 1
    repository.change_participant(connection, participant.id, control_tries=tries)
    note(connection, participant, "control_answered", {"answer": answer, "try": tries})
    outcome = judge_control(answer == CONTROL_RIGHT, tries)
    if outcome is None:
        return Step.PRACTICE
    if outcome == Happening.PASSED_CONTROL:
        deal(connection, study, participant)
    return _go_on(connection, participant, outcome)


def has_place(connection: Connection, participant: Record) -> bool:
    """Whether the participant holds a place."""
    return repository.place_of(connection, participant.id) is not None


def deal(connection: Connection, study: Study, participant: Record) -> Record:
    """The participant's place, dealt now if they have none; late unplayed places go first."""
    place = repository.place_of(connection, participant.id)
    if place:
        return place
    late = repository.now() - timedelta(minutes=study.settings.place_minutes)
    repository.free_unplayed_places(connection, participant.stream, late)
    place = repository.free_place(connection, participant.stream)
    if place is None:
        _add_block(connection, study, participant.stream)
        place = repository.free_place(connection, participant.stream)
        assert place is not None
    repository.give_place(connection, place, participant.id)
    note(connection, participant, "dealt", {"place": place.number})
    return place


def fail(connection: Connection, token: str | None) -> None:
    """End for a participant for whom the study does not work technically."""
    participant = participant_of(connection, token)
    _go_on(connection, participant, Happening.BROKE)
    repository.free_unplayed_place_of(connection, participant.id)


def withdraw(connection: Connection, token: str | None, journal: Path) -> None:
    """Delete all that is known of a participant, and note it outside the database."""
    participant = participant_of(connection, token)
    # Noted before the commit: a withdrawal that is half done is done at the next start.
    with journal.open("a", encoding="ascii") as file:
        file.write(f"{participant.pseudonym}\n")
        file.flush()
        os.fsync(file.fileno())
    _forget(connection, participant)


def withdraw_again(connection: Connection, journal: Path) -> None:
    """Drop those who withdrew from a database that was restored from an older backup."""
    for pseudonym in journal.read_text(encoding="ascii").split() if journal.exists() else ():
        participant = repository.participant_named(connection, pseudonym)
        if participant and participant.step != Step.WITHDRAWN:
            _forget(connection, participant)


def note(
    connection: Connection, participant: Record, what: str, details: Mapping[str, object]
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
                "study_hash": participant.study_hash,
                "app_version": VERSION,
            }
        ],
    )


def _begin_session(connection: Connection, participant: Record, what: str) -> str:
    token = secrets.token_urlsafe(32)
    repository.begin_session(connection, participant.id, hashed(token))
    note(connection, participant, what, {})
    return token


def _go_on(connection: Connection, participant: Record, happening: Happening) -> Step:
    step = advance(Step(participant.step), happening)
    ended = {"finished_at": repository.now()} if step in ENDINGS else {}
    repository.change_participant(connection, participant.id, step=step, **ended)
    note(connection, participant, happening.value, {})
    return step


def _add_block(connection: Connection, study: Study, stream: str) -> None:
    drawn = repository.drawn_from(connection)
    block = repository.count_places(connection, stream) // drawn.block_size
    dealt = deal_block(drawn.seed, stream, block, drawn.block_size, study.pool.scenarios)
    repository.add_places(
        connection,
        (
            {
                "stream": stream,
                "number": place.number,
                "condition": place.condition,
                "scenarios": place.scenarios,
            }
            for place in dealt
        ),
    )


def _forget(connection: Connection, participant: Record) -> None:
    repository.free_unplayed_place_of(connection, participant.id)
    repository.erase(connection, participant.id)
    repository.change_participant(
        connection,
        participant.id,
        step=advance(Step(participant.step), Happening.WITHDREW),
        finished_at=repository.now(),
    )
