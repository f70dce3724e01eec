"""From consent to the trials, and every way out: one function per thing that happens.

Each takes the connection of an open transaction; `database.write` commits it before the reply.
"""

import os
from collections.abc import Mapping
from datetime import timedelta
from pathlib import Path

from sqlalchemy import Connection

from app import books, repository
from app.assignment import deal_block
from app.event_log import note
from app.questions import CONTROL_RIGHT
from app.repository import Record
from app.sessions import participant_of
from app.steps import ENDINGS, Happening, Step, advance, judge_control
from app.study import Study


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


def _go_on(connection: Connection, participant: Record, happening: Happening) -> Step:
    step = advance(Step(participant.step), happening)
    ended = {"finished_at": repository.now()} if step in ENDINGS else {}
    repository.change_participant(connection, participant.id, step=step, **ended)
    note(connection, participant, happening.value, {})
    return step


def _add_block(connection: Connection, study: Study, stream: str) -> None:
    drawn = books.drawn_from(connection)
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
