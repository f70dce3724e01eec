"""Every query about a participant; those about the whole study are in `books`.

Functions take an open connection and plain values, and apply no rules. Statements that run for
everybody are built once: building one takes longer than running it.
"""

import secrets
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from functools import lru_cache
from typing import Any

from sqlalchemy import Connection, Row, Update, bindparam, delete, func, select, update
from sqlalchemy.dialects.sqlite import insert

from app.tables import (
    demographics,
    events,
    participants,
    places,
    recruits,
    sessions,
    trials,
)

Record = Row[Any]


def now() -> datetime:
    """The server's clock, UTC."""
    return datetime.now(UTC)


# --- participants and their sessions -----------------------------------------------------------


_IN_SESSION = (
    select(participants, sessions.c.current, sessions.c.proven)
    .join(sessions, sessions.c.participant_id == participants.c.id)
    .where(sessions.c.token_hash == bindparam("token_hash"))
)


def participant_in_session(connection: Connection, token_hash: str) -> Record | None:
    """The participant of a session, with whether it is `current` and `proven`."""
    return connection.execute(_IN_SESSION, {"token_hash": token_hash}).one_or_none()


def participant_recruited(connection: Connection, stream: str, recruiter_id: str) -> Record | None:
    """The participant of a stream with a recruiter's id."""
    return connection.execute(
        select(participants)
        .join(recruits, recruits.c.participant_id == participants.c.id)
        .where(recruits.c.stream == stream, recruits.c.recruiter_id == recruiter_id)
    ).one_or_none()


_ARRIVED = select(participants).where(participants.c.arrival == bindparam("arrival"))


def participant_arrived(connection: Connection, arrival: str) -> Record | None:
    """The participant made from one showing of the consent form."""
    return connection.execute(_ARRIVED, {"arrival": arrival}).one_or_none()


def participant_named(connection: Connection, pseudonym: str) -> Record | None:
    """The participant with a pseudonym."""
    return connection.execute(
        select(participants).where(participants.c.pseudonym == pseudonym)
    ).one_or_none()


_ADD_PARTICIPANT = insert(participants).returning(participants)


def add_participant(connection: Connection, **values: Any) -> Record:
    """A new participant, as stored."""
    return connection.execute(_ADD_PARTICIPANT, values).one()


def add_recruit(connection: Connection, **values: Any) -> None:
    """Keep the recruiter's ids of a participant."""
    connection.execute(insert(recruits), values)


_END_SESSIONS = (
    update(sessions).where(sessions.c.participant_id == bindparam("of")).values(current=False)
)


def begin_session(
    connection: Connection, participant_id: int, token_hash: str, proven: bool
) -> None:
    """Make this the participant's current session; older ones stay, to be told so."""
    connection.execute(_END_SESSIONS, {"of": participant_id})
    session = {"token_hash": token_hash, "current": True, "began_at": now(), "proven": proven}
    connection.execute(insert(sessions), {"participant_id": participant_id, **session})


def prove_session(connection: Connection, participant_id: int) -> None:
    """Note that the participant's current browser has shown to be theirs."""
    connection.execute(
        update(sessions)
        .where(sessions.c.participant_id == participant_id, sessions.c.current)
        .values(proven=True)
    )


def recruit_of(connection: Connection, participant_id: int) -> Record | None:
    """The recruiter's ids of a participant who came with some."""
    return connection.execute(
        select(recruits).where(recruits.c.participant_id == participant_id)
    ).one_or_none()


@lru_cache
def _changing_participant(*names: str) -> Update:
    values: dict[str, Any] = {name: bindparam(f"new_{name}") for name in names}
    return update(participants).where(participants.c.id == bindparam("of")).values(values)


def change_participant(connection: Connection, participant_id: int, **values: Any) -> None:
    """Set columns of a participant."""
    new = {f"new_{name}": value for name, value in values.items()}
    connection.execute(_changing_participant(*values), {"of": participant_id, **new})


def add_demographics(
    connection: Connection, participant_id: int, answers: Mapping[str, str | int | None]
) -> None:
    """Keep what participants said about themselves."""
    connection.execute(insert(demographics), {"participant_id": participant_id, **answers})


def erase(connection: Connection, participant_id: int) -> None:
    """Delete all that is known of a participant but the emptied row and the place dealt."""
    for table in (trials, events, demographics, recruits, sessions):
        connection.execute(delete(table).where(table.c.participant_id == participant_id))
    kept = {"id", "pseudonym", "stream", "step", "study_hash", "app_version", "control_tries"}
    emptied = {column.name: None for column in participants.c if column.name not in kept}
    change_participant(connection, participant_id, **emptied, control_tries=0)


# --- places ------------------------------------------------------------------------------------


_PLACE_OF = select(places).where(places.c.participant_id == bindparam("participant_id"))


def place_of(connection: Connection, participant_id: int) -> Record | None:
    """The place a participant has."""
    return connection.execute(_PLACE_OF, {"participant_id": participant_id}).one_or_none()


_lowest_free = (
    select(func.min(places.c.number))
    .where(places.c.stream == bindparam("of"), places.c.dealt_at.is_(None))
    .scalar_subquery()
)
_GIVE_FREE_PLACE = (
    update(places)
    .where(places.c.stream == bindparam("of"), places.c.number == _lowest_free)
    .values(
        participant_id=bindparam("to"), dealt_at=bindparam("at"), ticket=bindparam("with_ticket")
    )
    .returning(places.c.number)
)


def give_free_place(connection: Connection, stream: str, participant_id: int) -> int | None:
    """Deal the lowest free number, so those given back first; None when there is none."""
    dealing = {"of": stream, "to": participant_id, "at": now()}
    dealing["with_ticket"] = secrets.token_hex(8)
    number: int | None = connection.scalar(_GIVE_FREE_PLACE, dealing)
    return number


def count_places(connection: Connection, stream: str) -> int:
    """How many places a stream has so far, dealt or not."""
    return (
        connection.scalar(select(func.count()).select_from(places).where(places.c.stream == stream))
        or 0
    )


def add_places(connection: Connection, rows: Iterable[Mapping[str, Any]]) -> None:
    """Add free places."""
    connection.execute(insert(places), list(rows))


_FREE_UNPLAYED = (
    update(places)
    .where(
        places.c.stream == bindparam("of"),
        places.c.played_at.is_(None),
        places.c.dealt_at < bindparam("before"),
    )
    .values(participant_id=None, dealt_at=None, ticket=None)
)


def free_unplayed_places(connection: Connection, stream: str, dealt_before: datetime) -> None:
    """Take back the places dealt before a time and never played."""
    connection.execute(_FREE_UNPLAYED, {"of": stream, "before": dealt_before})


def free_unplayed_place_of(connection: Connection, participant_id: int) -> None:
    """Take back a participant's place if it was never played."""
    connection.execute(
        update(places)
        .where(places.c.participant_id == participant_id, places.c.played_at.is_(None))
        .values(participant_id=None, dealt_at=None, ticket=None)
    )


def mark_place_played(connection: Connection, participant_id: int) -> None:
    """Note the first frame played on a participant's place: from here on it is theirs."""
    connection.execute(
        update(places)
        .where(places.c.participant_id == participant_id, places.c.played_at.is_(None))
        .values(played_at=now())
    )


# --- trials ------------------------------------------------------------------------------------


_last = trials.alias("last")
_AT_TRIAL = (
    select(
        participants,
        sessions.c.current,
        places.c.condition,
        places.c.scenarios,
        places.c.number,
        places.c.dealt_at,
        places.c.ticket,
        sessions.c.proven,
        *(
            column
            for column in _last.c
            if column.name not in participants.c and column.name != "participant_id"
        ),
    )
    .join(sessions, sessions.c.participant_id == participants.c.id)
    .outerjoin(places, places.c.participant_id == participants.c.id)
    .outerjoin(
        _last,
        (_last.c.participant_id == participants.c.id)
        & (
            _last.c.trial_index
            == select(func.max(trials.c.trial_index))
            .where(trials.c.participant_id == participants.c.id)
            .scalar_subquery()
        ),
    )
    .where(sessions.c.token_hash == bindparam("token_hash"))
)


def participant_at_trial(connection: Connection, token_hash: str) -> Record | None:
    """As `participant_in_session`, with their place and the trial they played last, if any."""
    return connection.execute(_AT_TRIAL, {"token_hash": token_hash}).one_or_none()


def last_trial(connection: Connection, participant_id: int) -> Record | None:
    """The trial a participant played last."""
    played = trials_of(connection, participant_id)
    return played[-1] if played else None


def trials_of(connection: Connection, participant_id: int) -> Sequence[Record]:
    """A participant's trials in order."""
    return connection.execute(
        select(trials)
        .where(trials.c.participant_id == participant_id)
        .order_by(trials.c.trial_index)
    ).all()


_COUNT_ANSWERS = (
    select(func.count())
    .select_from(trials)
    .where(
        trials.c.participant_id == bindparam("participant_id"), trials.c.answered_at.is_not(None)
    )
)


def count_answers(connection: Connection, participant_id: int) -> int:
    """How many trials a participant has answered."""
    return connection.scalar(_COUNT_ANSWERS, {"participant_id": participant_id}) or 0


_ADD_TRIAL = insert(trials)


def add_trial(connection: Connection, participant_id: int, **values: Any) -> None:
    """A trial whose first frame was played."""
    connection.execute(_ADD_TRIAL, {"participant_id": participant_id, **values})


@lru_cache
def _changing_trial(*names: str) -> Update:
    of_trial = (trials.c.participant_id == bindparam("of"), trials.c.trial_index == bindparam("at"))
    return update(trials).where(*of_trial).values({n: bindparam(f"new_{n}") for n in names})


def change_trial(connection: Connection, participant_id: int, index: int, **values: Any) -> None:
    """Add what became known of a trial."""
    new = {f"new_{name}": value for name, value in values.items()}
    connection.execute(_changing_trial(*values), {"of": participant_id, "at": index, **new})


# --- the log -----------------------------------------------------------------------------------


_LOG = insert(events).on_conflict_do_nothing()


def log(connection: Connection, rows: Sequence[Mapping[str, Any]]) -> None:
    """Append events; those of a message that was logged before are left out."""
    connection.execute(_LOG, list(rows))


_COUNT_EVENTS = (
    select(func.count())
    .select_from(events)
    .where(events.c.participant_id == bindparam("participant_id"))
)


def count_events(connection: Connection, participant_id: int) -> int:
    """How many events a participant's log has."""
    return connection.scalar(_COUNT_EVENTS, {"participant_id": participant_id}) or 0
