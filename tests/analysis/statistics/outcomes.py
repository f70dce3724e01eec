"""Outcomes made for the tests."""

import csv
from pathlib import Path

import numpy as np

from analysis.statistics.outcome import Outcome
from analysis.statistics.survival import Stops, stops


def outcome(y, treated, participant, scenario, name="measure", unit="points") -> Outcome:
    """An outcome of anything that becomes arrays; clusters may have any names."""
    return Outcome(
        name,
        unit,
        np.array(y, dtype=float),
        np.array(treated, dtype=bool),
        *(np.unique(each, return_inverse=True)[1] for each in (participant, scenario)),
    )


def column_of_fixture(path: Path, name: str) -> list[str]:
    """A column of the synthetic trials, as text."""
    with path.open(newline="") as file:
        return [row[name] for row in csv.DictReader(file)]


def stops_of_fixture(path: Path) -> Stops:
    """How the synthetic trials ended."""
    column = {
        name: np.array(column_of_fixture(path, name))
        for name in ("stop_time", "video_length", "correct", "condition", "participant", "video")
    }
    return stops(
        stop_time_s=column["stop_time"].astype(float),
        length_s=column["video_length"].astype(float),
        correct=column["correct"].astype(float),
        treated=column["condition"] == "polmdp",
        participant=np.unique(column["participant"], return_inverse=True)[1],
        scenario=np.unique(column["video"], return_inverse=True)[1],
    )


def of_fixture(path: Path, measure: str) -> Outcome:
    """`correct`, `time` (the full length where the guess was wrong) or `confidence`."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    correct = [float(row["correct"]) for row in rows]
    y = {
        "correct": correct,
        "time": [
            float(row["stop_time"] if right else row["video_length"])
            for row, right in zip(rows, correct, strict=True)
        ],
        "confidence": [float(row["confidence"]) for row in rows],
    }[measure]
    return outcome(
        y,
        [row["condition"] == "polmdp" for row in rows],
        [row["participant"] for row in rows],
        [row["video"] for row in rows],
        measure,
    )
