"""The trials: one function per thing that happens; all of them may be delivered again.

Each takes the connection of an open transaction; `database.write` commits it before the reply.
"""

from collections.abc import Callable
from dataclasses import dataclass
from hashlib import sha256

from sqlalchemy import Connection

from analysis import correct, score
from app import VERSION, repository
from app.errors import InvalidInput, NoSuchTrial, PlaceReturned, WrongStep
from app.event_log import PLAYED_ELSEWHERE, log_message, note
from app.repository import Record
from app.schemas import ENVELOPE, Answered, Logged, Message, Played, Stopped
from app.sessions import admitted, hashed, prove
from app.steps import Happening, Phase, Step, advance
from app.study import Study
from policies import Stimulus


@dataclass(frozen=True)
class Standing:
    """Where a participant is in the trials.

    `ticket` says, to nobody but us, which dealing of which place this is, at which speed; a trial
    that was begun keeps the speed it was begun with. `press_ms` is the stop as the page sent it,
    by which it knows it until it is loaded again.
    """

    index: int
    phase: Phase
    stimulus: Stimulus
    ticket: str
    step_ms: int
    lead_in_ms: int
    position_ms: float = 0
    stop_time_ms: float | None = None
    press_ms: float | None = None

    @property
    def length_ms(self) -> int:
        """Full motion of the animation, without lead-in."""
        return self.stimulus.steps * self.step_ms


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


def participant_at_trial(
    connection: Connection, token: str | None, page: str | None = None
) -> Record:
    """The participant of a session, with their place and the trial they played last.

    Refused as in `sessions.participant_of`.
    """
    return admitted(repository.participant_at_trial(connection, hashed(token)), page)


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
        ticket=_ticket(participant, participant.step_ms, participant.lead_in_ms),
        step_ms=participant.step_ms,
        lead_in_ms=participant.lead_in_ms,
        position_ms=participant.position_ms,
        stop_time_ms=participant.stop_time_ms,
        press_ms=participant.press_ms,
    )


def played(
    connection: Connection, study: Study, token: str | None, index: int, message: Played
) -> Reply:
    """The first frame was drawn: from the first trial's on, the place and its condition stay."""

    def begin(participant: Record, at: Standing) -> None:
        if message.ticket != at.ticket:
            raise PlaceReturned
        device = message.device.model_dump(exclude={"reduced_motion"})
        if index == 1:
            repository.mark_place_played(connection, participant.id)
            repository.change_participant(connection, participant.id, **device)
        elif any(getattr(participant, name) != value for name, value in device.items()):
            note(connection, study, participant, "device_changed", device)
        repository.add_trial(
            connection,
            participant.id,
            trial_index=index,
            stimulus=at.stimulus.id,
            study_hash=study.hash,
            app_version=VERSION,
            step_ms=at.step_ms,
            length_ms=at.length_ms,
            lead_in_ms=at.lead_in_ms,
            played_at=repository.now(),
            played_waited_ms=message.waited_ms,
            position_ms=0.0,
            reduced_motion=message.device.reduced_motion,
            times_clamped=message.clamped,
        )

    return _once(connection, study, token, index, message, Phase.READY, begin)


def stopped(
    connection: Connection, study: Study, token: str | None, index: int, message: Stopped
) -> Reply:
    """The motion ended, by Stop or by itself: the stop time is final."""

    def keep_stop(participant: Record, at: Standing) -> None:
        stop_ms = stop_time_ms(message, at.length_ms)
        facts = message.model_dump(
            exclude=ENVELOPE | {"stop_time_ms", "reached_end", "played_took_ms"}
        )
        if message.played_took_ms is not None:
            # It may have waited on its way, or for our database: the page knows that only now.
            waited_ms = max(participant.played_waited_ms or 0, message.played_took_ms)
            facts["played_waited_ms"] = waited_ms
        repository.change_trial(
            connection,
            participant.id,
            index,
            stopped_at=repository.now(),
            stopped_waited_ms=message.waited_ms,
            stop_time_ms=stop_ms,
            reached_end=stop_ms == at.length_ms,
            press_ms=message.stop_time_ms,
            times_clamped=bool(
                participant.times_clamped or message.clamped or stop_ms != message.stop_time_ms
            ),
            **facts,
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
        facts = message.model_dump(exclude=ENVELOPE | {"stop_time_ms"})
        if message.clamped:
            facts["times_clamped"] = True
        repository.change_trial(
            connection, participant.id, index, answered_at=repository.now(), **facts
        )
        prove(connection, participant)
        if index == study.trials:
            answers = repository.count_answers(connection, participant.id)
            assert answers == study.trials, f"{answers} answers after the last trial"
            step = advance(Step(participant.step), Happening.ANSWERED_ALL)
            repository.change_participant(
                connection, participant.id, step=step, finished_at=repository.now()
            )

    def is_of_this_stop(at: Standing) -> bool:
        return message.stop_time_ms in (at.stop_time_ms, at.press_ms)

    return _once(
        connection, study, token, index, message, Phase.ASKING, keep_answer, is_of_this_stop
    )


def logged(connection: Connection, study: Study, token: str | None, message: Logged) -> None:
    """Events that no answer carries, and how far a trial that is broken off was seen."""
    participant = participant_at_trial(connection, token, message.participant)
    index = message.trial_index
    if index is not None:
        require_trial(study, index)
    this = index is not None and index == participant.trial_index
    stimulus = participant.stimulus if this else None
    log_message(connection, study, participant, index, stimulus, message)
    if index and this and participant.stopped_at is None and message.position_ms is not None:
        seen = min(message.position_ms, participant.length_ms)
        if seen > participant.position_ms:
            repository.change_trial(connection, participant.id, index, position_ms=seen)


def played_elsewhere(
    connection: Connection, study: Study, token: str | None, index: int, message: Played
) -> None:
    """Note that a browser which the participant has left had begun a trial, and says so late.

    It may have shown the animation before the newer browser did, for which it began anew. Not so
    where the message had come, but not its reply: then it is logged under its key already.
    """
    participant = repository.participant_in_session(connection, hashed(token))
    if participant is not None and message.participant in (None, participant.pseudonym):
        details = {"waited_ms": message.waited_ms}
        note(connection, study, participant, PLAYED_ELSEWHERE, details, index, message.key)


def require_trial(study: Study, index: int) -> None:
    """NoSuchTrial unless the study has a trial of this number."""
    if not 1 <= index <= study.trials:
        raise NoSuchTrial(f"Expected a trial from 1 to {study.trials}.")


def stop_time_ms(message: Stopped, length_ms: float) -> float:
    """Where the motion had been seen to be at the press, ms: nothing is seen before it is drawn.

    The press's position, at most one usual frame after the last frame drawn, at most the length.
    """
    bounds = [message.stop_time_ms, length_ms]
    if message.last_frame_ms is not None:
        bounds.append(message.last_frame_ms + (message.frame_interval_ms or 0))
    return float(min(bounds))


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
    speed = (study.settings.step_ms, study.settings.lead_in_ms)
    return Standing(index, Phase.READY, stimulus, _ticket(participant, *speed), *speed)


def _ticket(participant: Record, step_ms: int, lead_in_ms: int) -> str:
    if participant.ticket:
        return f"{participant.ticket}-{step_ms}-{lead_in_ms}"
    # Dealt before tickets were drawn at random: pages that wait for Play hold this one.
    place = (participant.pseudonym, participant.number, participant.dealt_at.isoformat())
    return sha256(repr((*place, step_ms, lead_in_ms)).encode()).hexdigest()[:16]


def _once(
    connection: Connection,
    study: Study,
    token: str | None,
    index: int,
    message: Message,
    due: Phase,
    happen: Callable[[Record, Standing], None],
    applies: Callable[[Standing], bool] = lambda _at: True,
) -> Reply:
    """Let something happen to a trial if it is due; a stale message gets what is stored.

    The events that came with it are kept in any case, unless it is refused.
    """
    require_trial(study, index)
    participant = participant_at_trial(connection, token, message.participant)
    if participant.step == Step.COMPLETED:
        log_message(connection, study, participant, index, None, message)
        return Reply(repeated=True, done=True, standing=None)
    if participant.step != Step.TRIALS:
        raise WrongStep("The animations are not what comes next.")
    at = standing(study, participant)
    order = list(Phase)
    if (index, order.index(due)) > (at.index, order.index(at.phase)):
        raise WrongStep(f"Expected trial {at.index} ({at.phase}), came {index} ({due}).")
    stimulus = at.stimulus.id if index == at.index else None
    log_message(connection, study, participant, index, stimulus, message)
    if (index, due) != (at.index, at.phase) or not applies(at):
        return Reply(repeated=True, done=False, standing=at)
    happen(participant, at)
    if due != Phase.ASKING:
        return Reply(repeated=False, done=False, standing=None)
    if index == study.trials:
        return Reply(repeated=False, done=True, standing=None)
    return Reply(repeated=False, done=False, standing=_ready(study, participant, index + 1))
