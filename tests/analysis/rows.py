"""Rows made for the tests as the app makes them, and tables from elsewhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

from analysis import correct, prediction_time_s, score, too_fast

HERE = Path(__file__).parent
Row = dict[str, Any]
START = datetime(2025, 3, 1, 9, 30, tzinfo=UTC)


def trial_row(participant: str, index: int, condition: str, **changes: Any) -> Row:
    """One trial as the app would export it: the measures follow from guess, goal and times."""
    row: Row = {
        "participant": participant,
        "condition": condition,
        "scenario": f"S{index:02d}",
        "stimulus": f"hash-{condition}-{index}",
        "maze": "spiral",
        "trial_index": index,
        "goal": "B",
        "guess": "B",
        "stop_time_s": 8.25 + index,
        "length_s": 20.0,
        "confidence": 6,
        "reached_end": False,
        "steps_seen": 9,
        "started_at": START,
        "stopped_at": START + timedelta(seconds=9, microseconds=123456),
        "answered_at": START + timedelta(seconds=12),
        "guess_latency_s": 1.5,
        "confidence_latency_s": 1.25,
        "lead_in_s": 1.0,
        "pauses": 0,
        "paused_s": 0.0,
        "focus_losses": 0,
        "reduced_motion": False,
        "frames_dropped": 2,
        "pointer_moved": True,
        "first_decision_s": 2.0,
        "last_frame_s": None,
        "frame_interval_s": 0.0167,
        "played_waited_s": 0.0,
        "stopped_waited_s": None,
        "server_stretch_s": 30.5,
        "impossible_time": False,
        "times_clamped": False,
        "watched_elsewhere": False,
        "simulated": False,
        "preview": False,
        "study_hash": "study",
        "app_version": "0.1.0",
    } | changes
    was_correct = correct(row["guess"], row["goal"])
    times = row["stop_time_s"], row["length_s"]
    derived = {
        "correct": was_correct,
        "prediction_time_s": prediction_time_s(*times, was_correct),
        "score": score(was_correct, *times),
        "too_fast": too_fast(row["stop_time_s"], row["first_decision_s"]),
        "press_s": row["stop_time_s"],
    }
    return derived | row


def participant_row(participant: str, condition: str | None, **changes: Any) -> Row:
    return {
        "participant": participant,
        "condition": condition,
        "status": "completed",
        "age": 30,
        "gender": "woman",
        "nationality": "Portugal",
        "education": "bachelor",
        "occupation": "nurse",
        "robot_familiarity": "a little",
        "consented_at": START,
        "dealt_at": START + timedelta(minutes=2),
        "first_played_at": START + timedelta(minutes=3),
        "finished_at": None,
        "control_tries": 1,
        "trials_answered": 3,
        "score": 25.5,
        "never_moved_pointer": False,
        "same_guess": False,
        "same_confidence": None,
        "too_fast_trials": 0,
        "pauses": 1,
        "focus_losses": 2,
        "frames_dropped": 6,
        "about_you_s": 62.5,
        "instructions_s": 20.25,
        "practice_s": 41.0,
        "trials_s": 301.5 if changes.get("status", "completed") == "completed" else None,
        "recruited": True,
        "pilot_before": False,
        "impossible_time": False,
        "user_agent": 'Browser "x", 1.0',
        "viewport_width": 1280,
        "viewport_height": 720,
        "pixel_ratio": 1.5,
        "refresh_rate_hz": 59.94,
        "pointer_type": "mouse",
        "simulated": False,
        "preview": False,
        "consent_hash": "consent",
        "study_hash": "study",
        "app_version": "0.1.0",
    } | changes


def event_row(event_id: int, **changes: Any) -> Row:
    return {
        "participant": "P1",
        "event_id": event_id,
        "trial_index": None,
        "type": "hidden",
        "server_time": START,
        "client_time_ms": 1234.5,
        "details": '{"why": "tab"}',
        "stimulus": None,
        "study_hash": "study",
        "app_version": "0.1.0",
    } | changes


def six_participants() -> list[Row]:
    """Three participants an arm, three trials each; the reference arm errs in its last trial."""
    rows = []
    for number in range(1, 7):
        condition = "polmdp" if number <= 3 else "optimal"
        for index in range(1, 4):
            wrong = condition == "optimal" and index == 3
            rows.append(
                trial_row(
                    f"P{number}",
                    index,
                    condition,
                    guess="A" if wrong else "B",
                    stop_time_s=5.0 + index + number,
                    confidence=8 - number if number > 1 else 6,
                )
            )
    return rows


def participants_of(rows: list[Row]) -> list[Row]:
    conditions = {row["participant"]: row["condition"] for row in rows}
    return [participant_row(name, condition) for name, condition in conditions.items()]


def edited(path: Path, row: int, column: str, text: str) -> None:
    """Change one cell of a CSV without quoted cells; rows count as in a spreadsheet."""
    lines = path.read_text().splitlines()
    cells = lines[row - 1].split(",")
    cells[lines[0].split(",").index(column)] = text
    lines[row - 1] = ",".join(cells)
    path.write_text("\n".join(lines) + "\n")


def as_csv(path: Path, rows: Sequence[Mapping[str, Any]]) -> Path:
    """Write a table from elsewhere: any columns, None as an empty cell."""
    lines = [",".join(rows[0])]
    lines += [",".join("" if cell is None else str(cell) for cell in row.values()) for row in rows]
    path.write_text("\n".join(lines) + "\n")
    return path
