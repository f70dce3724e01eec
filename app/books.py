"""Every query about the whole study: its definitions, its seed, its counts, whole tables.

Functions take an open connection and plain values, and apply no rules.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from sqlalchemy import Connection, delete, exists, func, select
from sqlalchemy.dialects.sqlite import insert

from app.repository import Record, now
from app.tables import (
    declined,
    demographics,
    events,
    participants,
    places,
    randomisation,
    recruits,
    studies,
    tallies,
    trials,
)


def register_study(
    connection: Connection, study_hash: str, definition: Mapping[str, Any], pool_hash: str
) -> None:
    """Keep a definition of the study for those who read its hash later."""
    connection.execute(
        insert(studies)
        .values(hash=study_hash, definition=definition, pool_hash=pool_hash, first_used_at=now())
        .on_conflict_do_nothing()
    )


def pool_in_use(connection: Connection) -> str | None:
    """Hash of the pool that the places of this database were dealt from."""
    return connection.scalar(select(studies.c.pool_hash).limit(1))


def draw_from(connection: Connection, seed: int, block_size: int) -> None:
    """Store what the dealing is drawn from, unless this database has it already."""
    connection.execute(
        insert(randomisation)
        .values(id=1, seed=seed, block_size=block_size)
        .on_conflict_do_nothing()
    )


def drawn_from(connection: Connection) -> Record:
    """Seed and block size of the dealing."""
    return connection.execute(select(randomisation)).one()


def tally(connection: Connection, name: str, more: int = 1) -> None:
    """Count one more of something, or one less, without saying of whom."""
    statement = insert(tallies).values(name=name, count=more)
    connection.execute(
        statement.on_conflict_do_update(
            index_elements=["name"], set_={"count": tallies.c.count + more}
        )
    )


def note_no(connection: Connection, arrival: str) -> bool:
    """Note that a showing of the consent form was answered with no; False if it was already."""
    noted = connection.execute(insert(declined).values(arrival=arrival).on_conflict_do_nothing())
    return noted.rowcount == 1


def take_back_no(connection: Connection, arrival: str) -> bool:
    """Forget that a showing of the consent form was answered with no; False if it was not."""
    return connection.execute(delete(declined).where(declined.c.arrival == arrival)).rowcount == 1


def count_participants(connection: Connection) -> dict[str, int]:
    """How many participants there are of whom something is kept, by stream."""
    people = (
        select(participants.c.stream, func.count())
        # Of who withdrew this is not known any more.
        .where(participants.c.consented_at.is_not(None))
        .group_by(participants.c.stream)
    )
    return {row[0]: row[1] for row in connection.execute(people)}


def count_answers(connection: Connection, stream: str) -> int:
    """How many trials the participants of a stream have answered."""
    answered = (
        select(func.count())
        .select_from(trials)
        .join(participants, participants.c.id == trials.c.participant_id)
        .where(participants.c.stream == stream, trials.c.answered_at.is_not(None))
    )
    return connection.scalar(answered) or 0


def all_studies(connection: Connection) -> dict[str, Any]:
    """Every definition of the study this database was used with, by its hash."""
    return {row.hash: row.definition for row in connection.execute(select(studies))}


def all_tallies(connection: Connection) -> dict[str, int]:
    """The anonymous counts, by name."""
    return {row[0]: row[1] for row in connection.execute(select(tallies))}


def all_recruits(connection: Connection, stream: str) -> Iterable[Record]:
    """The recruiter's ids of a stream with their participants, in order of arrival."""
    return connection.execute(
        select(
            recruits, participants.c.step, participants.c.consented_at, participants.c.finished_at
        )
        .join(participants, participants.c.id == recruits.c.participant_id)
        .where(recruits.c.stream == stream)
        .order_by(participants.c.id)
    )


def everybody_recruited_as(connection: Connection, recruiter_id: str) -> Sequence[Record]:
    """The participants of all streams with a recruiter's id, stored with blanks or without."""
    return connection.execute(
        select(participants)
        .join(recruits, recruits.c.participant_id == participants.c.id)
        .where(func.trim(recruits.c.recruiter_id) == recruiter_id)
        .order_by(participants.c.id)
    ).all()


def count_without_id(connection: Connection, stream: str) -> int:
    """How many of a stream came without a recruiter's id, of those that still have any."""
    has_id = exists().where(recruits.c.participant_id == participants.c.id)
    counted = select(func.count()).where(
        participants.c.stream == stream, participants.c.consented_at.is_not(None), ~has_id
    )
    return connection.scalar(counted) or 0


def all_trials(connection: Connection) -> Iterable[Record]:
    """Every answered trial with its participant and condition, in order."""
    return connection.execute(
        select(
            trials,
            places.c.condition,
            participants.c.pseudonym,
            participants.c.stream,
        )
        .join(participants, participants.c.id == trials.c.participant_id)
        .join(places, places.c.participant_id == participants.c.id)
        .where(trials.c.answered_at.is_not(None))
        .order_by(participants.c.id, trials.c.trial_index)
    )


def all_participants(connection: Connection) -> Iterable[Record]:
    """Every participant with place and demographics, in order of arrival.

    `recruited`: whether there is a recruiter's id of theirs.
    """
    return connection.execute(
        select(
            participants,
            recruits.c.participant_id.is_not(None).label("recruited"),
            places.c.condition,
            places.c.dealt_at,
            places.c.played_at,
            *(column for column in demographics.c if column.name != "participant_id"),
        )
        .outerjoin(places, places.c.participant_id == participants.c.id)
        .outerjoin(demographics, demographics.c.participant_id == participants.c.id)
        .outerjoin(recruits, recruits.c.participant_id == participants.c.id)
        .order_by(participants.c.id)
    )


def count_by_stream(connection: Connection) -> dict[str, int]:
    """How many participants each stream has."""
    counts = select(participants.c.stream, func.count()).group_by(participants.c.stream)
    return {row[0]: row[1] for row in connection.execute(counts)}


def events_of_types(connection: Connection, types: Iterable[str]) -> Iterable[Record]:
    """The log's events of some types, in the order of participants and then of the log."""
    return connection.execute(
        select(events.c.participant_id, events.c.trial_index, events.c.type, events.c.server_time)
        .where(events.c.type.in_(types))
        .order_by(events.c.participant_id, events.c.id)
    )


def all_events(connection: Connection) -> Iterable[Record]:
    """The log with pseudonyms, in its order."""
    return connection.execute(
        select(events, participants.c.pseudonym, participants.c.stream)
        .join(participants, participants.c.id == events.c.participant_id)
        .order_by(events.c.id)
    )
