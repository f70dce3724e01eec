"""The export: raw rows and what is derived of them, as the tables of analysis.contract."""

import json
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sqlalchemy import Connection

from analysis import (
    EVENTS,
    PARTICIPANTS,
    TRIALS,
    code_book,
    prediction_time_s,
    too_fast,
    write_table,
)
from app import books
from app.answering import score_trial
from app.database import Database
from app.quality import alike, first_decision_s, never_moved_pointer, times_s
from app.repository import Record
from app.schemas import pointer_type
from app.steps import ON_THE_WAY, Happening, Step
from app.study import PREVIEW, SIMULATED, Study

Row = dict[str, Any]

_HAPPENINGS = frozenset(map(str, Happening))


@dataclass(frozen=True)
class Exported:
    """How many rows of each table were written, and how many pilots were left out."""

    rows: dict[str, int]
    pilots_left_out: int


def export(database: Database, study: Study, folder: Path, simulated: bool) -> Exported:
    """Write the three tables, the code book, and what the study's hashes stand for.

    Rows of simulated and preview participants are written only if asked for. All files show
    the database at one moment, also while the study runs.
    """

    def gather(connection: Connection) -> tuple[dict[str, list[Row]], Row]:
        trials = [_trial(study, record) for record in books.all_trials(connection)]
        events = [_event(record) for record in books.all_events(connection)]
        tables = {
            TRIALS.name: trials,
            PARTICIPANTS.name: list(_participants(connection, trials, events)),
            EVENTS.name: events,
        }
        about = {"counts": books.all_tallies(connection), "studies": books.all_studies(connection)}
        return tables, about

    rows, about = database.read_now(gather)
    pilots = {
        row["participant"] for row in rows[PARTICIPANTS.name] if row["simulated"] or row["preview"]
    }
    left_out = set() if simulated else pilots
    kept = {
        name: [row for row in table if row["participant"] not in left_out]
        for name, table in rows.items()
    }
    folder.mkdir(parents=True, exist_ok=True)
    for table in (TRIALS, PARTICIPANTS, EVENTS):
        write_table(table, kept[table.name], folder)
    (folder / "codebook.md").write_text(code_book(), encoding="utf-8")
    text = json.dumps(about, indent=2, sort_keys=True, ensure_ascii=False)
    (folder / "study.json").write_text(f"{text}\n", encoding="utf-8")
    return Exported({name: len(table) for name, table in kept.items()}, len(left_out))


def _trial(study: Study, record: Record) -> Row:
    derived = score_trial(study, record)
    decision_s = first_decision_s(
        study.pool.scenes[derived.stimulus.maze], derived.stimulus, record.step_ms
    )
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
        **_marks(record),
    }


def _participants(connection: Connection, trials: list[Row], events: list[Row]) -> Iterator[Row]:
    trials_of, events_of = _by_participant(trials), _by_participant(events)
    for record in books.all_participants(connection):
        theirs = trials_of[record.pseudonym]
        yield {
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
            "trials_answered": len(theirs),
            "score": sum(trial["score"] for trial in theirs) if theirs else None,
            **_signs(theirs),
            **_times(record, events_of[record.pseudonym]),
            "user_agent": record.user_agent,
            "viewport_width": record.viewport_width,
            "viewport_height": record.viewport_height,
            "pixel_ratio": record.pixel_ratio,
            "refresh_rate_hz": record.refresh_rate_hz,
            "pointer_type": pointer_type(record.pointer_type),
            "consent_hash": record.consent_hash,
            **_marks(record),
        }


def _by_participant(rows: list[Row]) -> defaultdict[str, list[Row]]:
    found: defaultdict[str, list[Row]] = defaultdict(list)
    for row in rows:
        found[row["participant"]].append(row)
    return found


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


def _times(record: Record, events: list[Row]) -> Row:
    """Time at each step on the way, empty where it was not finished."""
    happened = [
        (Happening(event["type"]), event["server_time"])
        for event in events
        if event["type"] in _HAPPENINGS
    ]
    # The log has the last answer, but not that it was the last.
    if record.step == Step.COMPLETED:
        happened.append((Happening.ANSWERED_ALL, record.finished_at))
    times = times_s(record.consented_at, happened)
    return {f"{step}_s": times.get(step) for step in ON_THE_WAY}


def _event(record: Record) -> Row:
    return {
        "participant": record.pseudonym,
        "event_id": record.id,
        "trial_index": record.trial_index,
        "type": record.type,
        "server_time": record.server_time,
        "client_time_ms": record.client_time_ms,
        "details": json.dumps(record.details, sort_keys=True),
        "stimulus": record.stimulus,
        "study_hash": record.study_hash,
        "app_version": record.app_version,
    }


def _marks(record: Record) -> Row:
    return {
        "simulated": record.stream == SIMULATED,
        "preview": record.stream == PREVIEW,
        "study_hash": record.study_hash,
        "app_version": record.app_version,
    }
