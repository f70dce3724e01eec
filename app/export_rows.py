"""The rows of the export: what was recorded of one participant, and what is derived of it."""

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
from operator import attrgetter
from typing import Any

from sqlalchemy import Connection

from analysis import prediction_time_s, too_fast
from app import books
from app.answering import score_trial
from app.event_log import CAME_BACK, PLAYED_ELSEWHERE
from app.quality import alike, first_decision_s, never_moved_pointer, times_s
from app.repository import Record
from app.schemas import pointer_type
from app.steps import ON_THE_WAY, Happening, Step
from app.study import PREVIEW, SIMULATED, Study
from app.trial_times import TrialTimes, are_impossible, is_impossible, server_stretch_s
from policies import Stimulus

Row = dict[str, Any]

_HAPPENINGS = frozenset(map(str, Happening))


@dataclass(frozen=True)
class Person:
    """What is stored of one participant.

    `trials` are those answered, in order; `events` those of the log that something is derived of.
    """

    record: Record
    trials: list[Record]
    events: list[Record]

    def moved_during(self, trial: Record) -> bool:
        """Whether they went on in another browser while a trial's animation was moving."""
        return any(
            event.type == CAME_BACK and trial.played_at <= event.server_time <= trial.stopped_at
            for event in self.events
        )

    @cached_property
    def times(self) -> list[TrialTimes]:
        """When each trial was given out and answered, and what its page says of times."""
        given_out = [self.record.dealt_at, *(trial.answered_at for trial in self.trials)]
        return [
            TrialTimes(
                available_since=available_since,
                played_at=trial.played_at,
                stopped_at=trial.stopped_at,
                answered_at=trial.answered_at,
                lead_in_ms=trial.lead_in_ms,
                played_waited_ms=trial.played_waited_ms,
                # In another browser it is taken to have been seen for as long as it can have been.
                seen_ms=0.0 if self.moved_during(trial) else trial.position_ms,
                stop_time_ms=trial.stop_time_ms,
            )
            for available_since, trial in zip(given_out[:-1], self.trials, strict=True)
        ]


def people(connection: Connection) -> Iterator[Person]:
    """Every participant in order of arrival, one in memory at a time."""
    trials = _InStep(books.all_trials(connection))
    types = [*Happening, PLAYED_ELSEWHERE, CAME_BACK]
    events = _InStep(books.events_of_types(connection, types))
    for record in books.all_participants(connection):
        yield Person(record, trials.of(record.id), events.of(record.id))


class _InStep:
    """Rows in the order of their participants, handed out participant by participant."""

    def __init__(self, rows: Iterable[Record]) -> None:
        self._groups = groupby(rows, key=attrgetter("participant_id"))
        self._next = next(self._groups, None)

    def of(self, participant_id: int) -> list[Record]:
        """The rows of a participant; whoever is asked for comes after all who were."""
        if self._next is None or self._next[0] != participant_id:
            return []
        rows = list(self._next[1])
        self._next = next(self._groups, None)
        return rows


@dataclass(frozen=True)
class Derivation:
    """Makes rows of what is stored, by the definitions of a study."""

    study: Study
    _decisions_s: dict[tuple[str, int], float] = field(default_factory=dict)

    def trials(self, person: Person) -> list[Row]:
        """The rows of a participant's answered trials."""
        elsewhere = {event.trial_index for event in person.events if event.type == PLAYED_ELSEWHERE}
        return [
            self._trial(trial, times, trial.trial_index in elsewhere or person.moved_during(trial))
            for trial, times in zip(person.trials, person.times, strict=True)
        ]

    def participant(self, person: Person) -> Row:
        """The row of a participant."""
        record, trials = person.record, self.trials(person)
        return {
            "participant": record.pseudonym,
            "condition": record.condition,
            "status": record.step,
            "age": record.age,
            "gender": record.gender,
            "nationality": record.nationality,
            "education": record.education,
            "occupation": record.occupation,
            "robot_familiarity": record.robot_familiarity,
            "consented_at": record.consented_at,
            "dealt_at": record.dealt_at,
            "first_played_at": record.played_at,
            "finished_at": record.finished_at,
            "control_tries": record.control_tries,
            "trials_answered": len(trials),
            "score": sum(trial["score"] for trial in trials) if trials else None,
            **_signs(trials),
            **_times(person),
            "recruited": None if record.step == Step.WITHDRAWN else record.recruited,
            "pilot_before": record.pilot_before,
            "impossible_time": _unless_simulated(record, are_impossible(person.times)),
            "user_agent": record.user_agent,
            "viewport_width": record.viewport_width,
            "viewport_height": record.viewport_height,
            "pixel_ratio": record.pixel_ratio,
            "refresh_rate_hz": record.refresh_rate_hz,
            "pointer_type": pointer_type(record.pointer_type),
            "consent_hash": record.consent_hash,
            **_marks(record),
        }

    def _trial(self, record: Record, times: TrialTimes, elsewhere: bool) -> Row:
        derived = score_trial(self.study, record)
        decision_s = self._decision_s(derived.stimulus, record.step_ms)
        return {
            "participant": record.pseudonym,
            "condition": record.condition,
            "scenario": derived.stimulus.scenario,
            "stimulus": record.stimulus,
            "maze": derived.stimulus.maze,
            "trial_index": record.trial_index,
            "goal": derived.stimulus.goal,
            "guess": record.guess,
            "correct": derived.correct,
            "stop_time_s": derived.stop_time_s,
            "length_s": derived.length_s,
            "prediction_time_s": prediction_time_s(
                derived.stop_time_s, derived.length_s, derived.correct
            ),
            "score": derived.score,
            "confidence": record.confidence,
            "reached_end": record.reached_end,
            "steps_seen": derived.steps_seen,
            "started_at": record.played_at,
            "stopped_at": record.stopped_at,
            "answered_at": record.answered_at,
            "guess_latency_s": record.guess_latency_ms / 1000,
            "confidence_latency_s": record.confidence_latency_ms / 1000,
            "lead_in_s": record.lead_in_ms / 1000,
            "pauses": record.pauses,
            "paused_s": record.paused_ms / 1000,
            "focus_losses": record.focus_losses,
            "reduced_motion": record.reduced_motion,
            "frames_dropped": record.frames_dropped,
            "pointer_moved": record.pointer_moved,
            "first_decision_s": decision_s,
            "too_fast": too_fast(derived.stop_time_s, decision_s),
            "press_s": _seconds(record.press_ms),
            "last_frame_s": _seconds(record.last_frame_ms),
            "frame_interval_s": _seconds(record.frame_interval_ms),
            "played_waited_s": _seconds(record.played_waited_ms),
            "stopped_waited_s": _seconds(record.stopped_waited_ms),
            "server_stretch_s": server_stretch_s(times),
            "impossible_time": _unless_simulated(record, is_impossible(times)),
            "times_clamped": record.times_clamped,
            "watched_elsewhere": elsewhere,
            **_marks(record),
        }

    def _decision_s(self, stimulus: Stimulus, step_ms: int) -> float:
        """When the first decision was there to be seen; looked for once for each stimulus."""
        shown = (stimulus.id, step_ms)
        if shown not in self._decisions_s:
            scene = self.study.pool.scenes[stimulus.maze]
            self._decisions_s[shown] = first_decision_s(scene, stimulus, step_ms)
        return self._decisions_s[shown]


def event_row(study: Study, record: Record) -> Row:
    """The row of an event of the log."""
    # Older versions logged whatever number the page's address had.
    of_a_trial = record.trial_index is not None and 1 <= record.trial_index <= study.trials
    return {
        "participant": record.pseudonym,
        "event_id": record.id,
        "trial_index": record.trial_index if of_a_trial else None,
        "type": record.type,
        "server_time": record.server_time,
        "client_time_ms": record.client_time_ms,
        "details": json.dumps(record.details, sort_keys=True),
        "stimulus": record.stimulus,
        "study_hash": record.study_hash,
        "app_version": record.app_version,
    }


def _signs(trials: list[Row]) -> Row:
    """Data quality over the answered trials of one participant."""
    return {
        "never_moved_pointer": never_moved_pointer([trial["pointer_moved"] for trial in trials]),
        "same_guess": alike([trial["guess"] for trial in trials]),
        "same_confidence": alike([trial["confidence"] for trial in trials]),
        "too_fast_trials": sum(trial["too_fast"] for trial in trials),
        "pauses": sum(trial["pauses"] for trial in trials),
        "focus_losses": sum(trial["focus_losses"] for trial in trials),
        "frames_dropped": sum(trial["frames_dropped"] for trial in trials),
    }


def _times(person: Person) -> Row:
    """Time at each step on the way, empty where it was not finished."""
    happened = [
        (Happening(event.type), event.server_time)
        for event in person.events
        if event.type in _HAPPENINGS
    ]
    # The log has the last answer, but not that it was the last.
    if person.record.step == Step.COMPLETED:
        happened.append((Happening.ANSWERED_ALL, person.record.finished_at))
    times = times_s(person.record.consented_at, happened)
    return {f"{step}_s": times.get(step) for step in ON_THE_WAY}


def _unless_simulated(record: Record, sign: bool | None) -> bool | None:
    """A sign by the server's clock; simulated participants keep a clock of their own."""
    return None if record.stream == SIMULATED else sign


def _seconds(milliseconds: float | None) -> float | None:
    return None if milliseconds is None else milliseconds / 1000


def _marks(record: Record) -> Row:
    return {
        "simulated": record.stream == SIMULATED,
        "preview": record.stream == PREVIEW,
        "study_hash": record.study_hash,
        "app_version": record.app_version,
    }
