"""The trials: one function per thing that happens; all of them may be delivered again.

Each takes the connection of an open transaction; `database.write` commits it before the reply.
"""

from collections.abc import Callable
from dataclasses import dataclass

from sqlalchemy import Connection

from analysis import correct, score
from app import repository
from app.errors import InvalidInput, PlaceReturned, WrongStep
from app.event_log import log_message
from app.repository import Record
from app.schemas import Answered, Logged, Message, Played, Stopped
from app.sessions import admitted, hashed
from app.steps import Happening, Phase, Step, advance
from app.study import Study
from policies import Stimulus


@dataclass(frozen=True)
class Standing:
    """Where a participant is in the trials."""

    index: int
    phase: Phase
    stimulus: Stimulus
    length_ms: int
    position_ms: float = 0
    stop_time_ms: float | None = None


@dataclass(frozen=True)
class Reply:
    """What the page is told: `standing` is None where it knows it anyway, or all is done."""

    repeated: bool
    done: bool
    standing: Standing | None


@dataclass(frozen=True)
class TrialScore:
    """A finished trial, as the last page shows it."""

    index: int
    stimulus: Stimulus
    guess: str
    correct: bool
    stop_time_s: float
    length_s: float
    steps_seen: int
    score: float


def participant_at_trial(connection: Connection, token: str | None) -> Record:
    """The participant of a session, with their place and the trial they played last."""
    return admitted(repository.participant_at_trial(connection, hashed(token)))


def standing(study: Study, participant: Record) -> Standing:
    """The trial a `participant_at_trial` is at; PlaceReturned when they have no place."""
    if participant.scenarios is None:
        raise PlaceReturned
    if participant.trial_index is None:
        return _ready(study, participant, 1)
    if participant.answered_at is not None:
        return _ready(study, participant, participant.trial_index + 1)
    return Standing(
        index=participant.trial_index,
        phase=Phase.MOVING if participant.stopped_at is None else Phase.ASKING,
        stimulus=study.pool.stimuli[participant.stimulus],
        length_ms=participant.length_ms,
        position_ms=participant.position_ms,
        stop_time_ms=participant.stop_time_ms,
    )


def played(
    connection: Connection, study: Study, token: str | None, index: int, message: Played
) -> Reply:
    """The first frame was drawn: from the first trial's on, the place and its condition stay."""

    def begin(participant: Record, at: Standing) -> None:
        if index == 1:
            repository.mark_place_played(connection, participant.id)
            device = message.device.model_dump(exclude={"reduced_motion"})
            repository.change_participant(connection, participant.id, **device)
        repository.add_trial(
            connection,
            participant.id,
            trial_index=index,
            stimulus=at.stimulus.id,
            step_ms=study.settings.step_ms,
            length_ms=at.length_ms,
            lead_in_ms=study.settings.lead_in_ms,
            played_at=repository.now(),
            position_ms=0.0,
            reduced_motion=message.device.reduced_motion,
        )

    return _once(connection, study, token, index, message, Phase.READY, begin)


def stopped(
    connection: Connection, study: Study, token: str | None, index: int, message: Stopped
) -> Reply:
    """The motion ended, by Stop or by itself: the stop time is final."""

    def keep_stop(participant: Record, at: Standing) -> None:
        stop_ms, length_ms = message.stop_time_ms, at.length_ms
        if stop_ms > length_ms:
            raise InvalidInput(f"stop_time_ms: expected from 0 to {length_ms}, came {stop_ms}")
        if message.reached_end and stop_ms != length_ms:
            raise InvalidInput(f"stop_time_ms: expected {length_ms} at the end, came {stop_ms}")
        facts = message.model_dump(exclude={"key", "events"})
        repository.change_trial(
            connection, participant.id, index, stopped_at=repository.now(), **facts
        )

    return _once(connection, study, token, index, message, Phase.MOVING, keep_stop)


def answered(
    connection: Connection, study: Study, token: str | None, index: int, message: Answered
) -> Reply:
    """The guess and the confidence; the reply carries the next trial."""

    def keep_answer(participant: Record, at: Standing) -> None:
        letters = [area.letter for area in study.pool.scenes[at.stimulus.maze].areas]
        if message.guess not in letters:
            raise InvalidInput(f"guess: expected one of {letters}, came {message.guess!r}")
        facts = message.model_dump(exclude={"key", "events"})
        repository.change_trial(
            connection, participant.id, index, answered_at=repository.now(), **facts
        )
        if repository.count_answers(connection, participant.id) == study.trials:
            step = advance(Step(participant.step), Happening.ANSWERED_ALL)
            repository.change_participant(
                connection, participant.id, step=step, finished_at=repository.now()
            )

    return _once(connection, study, token, index, message, Phase.ASKING, keep_answer)


def logged(connection: Connection, token: str | None, message: Logged) -> None:
    """Events that no answer carries, and how far a trial that is broken off was seen."""
    participant = participant_at_trial(connection, token)
    index = message.trial_index
    this = index is not None and index == participant.trial_index
    log_message(connection, participant, index, participant.stimulus if this else None, message)
    if index and this and participant.stopped_at is None and message.position_ms is not None:
        seen = min(message.position_ms, participant.length_ms)
        if seen > participant.position_ms:
            repository.change_trial(connection, participant.id, index, position_ms=seen)


def scores(connection: Connection, study: Study, participant: Record) -> list[TrialScore]:
    """The trials of somebody who has answered them all, with their scores."""
    return [score_trial(study, trial) for trial in repository.trials_of(connection, participant.id)]


def score_trial(study: Study, trial: Record) -> TrialScore:
    """What is derived of an answered trial, by the definitions of analysis.measures."""
    stimulus = study.pool.stimuli[trial.stimulus]
    right = correct(trial.guess, stimulus.goal)
    stop_time_s, length_s = trial.stop_time_ms / 1000, trial.length_ms / 1000
    return TrialScore(
        index=trial.trial_index,
        stimulus=stimulus,
        guess=trial.guess,
        correct=right,
        stop_time_s=stop_time_s,
        length_s=length_s,
        steps_seen=min(stimulus.steps, int(trial.stop_time_ms // trial.step_ms) + 1),
        score=score(right, stop_time_s, length_s),
    )


def _ready(study: Study, participant: Record, index: int) -> Standing:
    stimulus = study.pool.stimulus(participant.scenarios[index - 1], participant.condition)
    return Standing(index, Phase.READY, stimulus, study.length_ms(stimulus))


def _once(
    connection: Connection,
    study: Study,
    token: str | None,
    index: int,
    message: Message,
    due: Phase,
    happen: Callable[[Record, Standing], None],
) -> Reply:
    """Let something happen to a trial if it is due; a stale message gets what is stored."""
    participant = participant_at_trial(connection, token)
    if participant.step == Step.COMPLETED:
        return Reply(repeated=True, done=True, standing=None)
    if participant.step != Step.TRIALS:
        raise WrongStep("The animations are not what comes next.")
    at = standing(study, participant)
    order = list(Phase)
    if (index, order.index(due)) > (at.index, order.index(at.phase)):
        raise WrongStep(f"Expected trial {at.index} ({at.phase}), came {index} ({due}).")
    if (index, due) != (at.index, at.phase):
        return Reply(repeated=True, done=False, standing=at)
    happen(participant, at)
    log_message(connection, participant, index, at.stimulus.id, message)
    if due != Phase.ASKING:
        return Reply(repeated=False, done=False, standing=None)
    done = index == study.trials
    return Reply(
        repeated=False,
        done=done,
        standing=None if done else _ready(study, participant, index + 1),
    )
