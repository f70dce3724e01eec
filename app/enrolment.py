"""From consent to the trials, and every way out: one function per thing that happens.

Each takes the connection of an open transaction; `database.write` commits it before the reply.
"""

import os
from collections.abc import Mapping
from datetime import timedelta

from sqlalchemy import Connection

from app import books, repository
from app.assignment import deal_block
from app.database_files import append_privately
from app.errors import CLOSED_TO_WITHDRAWAL, DatabaseUnavailable, NotProven, StudyClosed
from app.event_log import note
from app.questions import CONTROL_RIGHT
from app.repository import Record
from app.sessions import participant_of, prove
from app.steps import ENDINGS, Happening, Step, advance, judge_control, may_withdraw
from app.study import Study


def describe(
    connection: Connection,
    study: Study,
    token: str | None,
    page: str | None,
    answers: Mapping[str, str | int | None],
) -> None:
    """Keep what a participant said about themselves and go on."""
    participant = participant_of(connection, token, page)
    _go_on(connection, study, participant, Happening.DESCRIBED)
    prove(connection, participant)
    repository.add_demographics(connection, participant.id, answers)


def finish_instructions(
    connection: Connection, study: Study, token: str | None, page: str | None = None
) -> None:
    """Go on from the instructions to the practice."""
    _go_on(connection, study, participant_of(connection, token, page), Happening.INSTRUCTED)


def answer_control(
    connection: Connection,
    study: Study,
    token: str | None,
    page: str | None,
    attempt: int,
    answer: str | int | None,
) -> Step:
    """Judge an attempt at the control question; who passes is dealt a place with it.

    Returns the step that follows. An attempt that is not the one due was sent twice, and is not
    judged again.
    """
    participant = participant_of(connection, token, page)
    if participant.step != Step.PRACTICE or attempt != participant.control_tries + 1:
        return Step(participant.step)
    repository.change_participant(connection, participant.id, control_tries=attempt)
    prove(connection, participant)
    told = {"answer": answer, "attempt": attempt}
    note(connection, study, participant, "control_answered", told)
    outcome = judge_control(answer == CONTROL_RIGHT, attempt)
    if outcome is None:
        return Step.PRACTICE
    if outcome == Happening.PASSED_CONTROL:
        deal(connection, study, participant)
    return _go_on(connection, study, participant, outcome)


def deal_again(
    connection: Connection, study: Study, token: str | None, page: str | None = None
) -> None:
    """Deal a place to a participant at the trials whose place went to somebody else."""
    participant = participant_of(connection, token, page)
    placed = repository.place_of(connection, participant.id) is not None
    if participant.step == Step.TRIALS and not placed:
        deal(connection, study, participant)


def deal(connection: Connection, study: Study, participant: Record) -> None:
    """Deal a place to a participant who has none; late unplayed places are given back first."""
    late = repository.now() - timedelta(minutes=study.settings.place_minutes)
    repository.free_unplayed_places(connection, participant.stream, late)
    place = repository.give_free_place(connection, participant.stream, participant.id)
    if place is None:
        _add_block(connection, study, participant.stream)
        place = repository.give_free_place(connection, participant.stream, participant.id)
    note(connection, study, participant, "dealt", {"place": place})


def fail(connection: Connection, study: Study, token: str | None, page: str | None = None) -> None:
    """End for a participant for whom the study does not work technically."""
    participant = participant_of(connection, token, page)
    _go_on(connection, study, participant, Happening.BROKE)
    repository.free_unplayed_place_of(connection, participant.id)


def require_way_out(study: Study, participant: Record) -> None:
    """NotProven in a browser that may be somebody else's, StudyClosed after the end of all."""
    if not participant.proven:
        raise NotProven
    if not may_withdraw(Step(participant.step), study.settings.study_open):
        raise StudyClosed(CLOSED_TO_WITHDRAWAL)


def withdraw(
    connection: Connection, study: Study, token: str | None, page: str | None = None
) -> str:
    """Withdraw the participant of a session, if they may; returns their stream."""
    participant = participant_of(connection, token, page)
    require_way_out(study, participant)
    withdraw_participant(connection, study, participant)
    stream: str = participant.stream
    return stream


def withdraw_recruited(connection: Connection, study: Study, recruiter_id: str) -> int:
    """Withdraw everybody with a recruiter's id, at whatever step; returns how many there were."""
    found = books.everybody_recruited_as(connection, recruiter_id)
    for participant in found:
        withdraw_participant(connection, study, participant)
    return len(found)


def withdraw_participant(connection: Connection, study: Study, participant: Record) -> None:
    """Delete all that is known of a participant, and note it outside the database."""
    # Noted before the commit: a withdrawal that is half done is done at the next start.
    file = study.settings.withdrawals_file
    try:
        with append_privately(file) as journal:
            # On a line of its own even if a crash cut the last one short.
            journal.write(f"\n{participant.pseudonym}\n")
            journal.flush()
            os.fsync(journal.fileno())
    except OSError as error:
        raise DatabaseUnavailable(f"{file}: {error.strerror}") from error
    _forget(connection, participant)


def withdraw_again(connection: Connection, study: Study) -> int:
    """Drop those who withdrew from a database that was restored; how many were still in it."""
    listed = study.settings.withdrawals_file
    if not listed.exists():
        return 0
    dropped = 0
    for pseudonym in listed.read_text(encoding="ascii", errors="replace").split():
        participant = repository.participant_named(connection, pseudonym)
        if participant and participant.step != Step.WITHDRAWN:
            _forget(connection, participant)
            dropped += 1
    return dropped


def _go_on(connection: Connection, study: Study, participant: Record, happening: Happening) -> Step:
    step = advance(Step(participant.step), happening)
    ended = {"finished_at": repository.now()} if step in ENDINGS else {}
    repository.change_participant(connection, participant.id, step=step, **ended)
    note(connection, study, participant, happening.value, {})
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
