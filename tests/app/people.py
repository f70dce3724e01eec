"""What participants do, as calls within an open transaction, in the order of the study."""

from sqlalchemy import Connection

from app import answering, arrival, enrolment
from app.arrival import Link
from app.questions import CONTROL_RIGHT
from app.schemas import Answered, Played, Stopped
from app.study import PARTICIPANT, Study
from tests import messages

ABOUT_ME: dict[str, str | int | None] = {**messages.ABOUT_ME, "age": 31}


def consent(connection: Connection, study: Study, stream: str = PARTICIPANT) -> str:
    """Begin a session and return its token."""
    link = Link(stream=stream)
    token = arrival.consent(connection, study, messages.key(), link, None, "test")
    assert token is not None
    return token


def describe(connection: Connection, study: Study, token: str) -> None:
    enrolment.describe(connection, study, token, None, ABOUT_ME)


def pass_control(connection: Connection, study: Study, token: str) -> None:
    enrolment.answer_control(connection, study, token, None, 1, CONTROL_RIGHT)


TO_THE_TRIALS = (describe, enrolment.finish_instructions, pass_control)
"""The transactions between consent and a place."""


def reach_trials(connection: Connection, study: Study, stream: str = PARTICIPANT) -> str:
    token = consent(connection, study, stream)
    for go_on in TO_THE_TRIALS:
        go_on(connection, study, token)
    return token


def ticket(connection: Connection, study: Study, token: str) -> str:
    """The ticket of the trial that comes next; PlaceReturned to who has lost their place."""
    participant = answering.participant_at_trial(connection, token)
    return answering.standing(study, participant).ticket


def play(connection: Connection, study: Study, token: str, ticket: str, index: int = 1) -> None:
    """The first frame of a trial."""
    message = Played.model_validate(messages.played(ticket))
    answering.played(connection, study, token, index, message)


def stop(connection: Connection, study: Study, token: str, index: int, stop_time_ms: float) -> None:
    message = Stopped.model_validate(messages.stopped(stop_time_ms))
    answering.stopped(connection, study, token, index, message)


def answer(
    connection: Connection,
    study: Study,
    token: str,
    index: int,
    stop_time_ms: float,
    guess: str,
    confidence: int,
) -> None:
    message = Answered.model_validate(messages.answered(guess, stop_time_ms, confidence))
    answering.answered(connection, study, token, index, message)
