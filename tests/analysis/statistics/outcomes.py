"""Outcomes made for the tests."""

import csv
from pathlib import Path

import numpy as np

from analysis.statistics.outcome import Outcome


def outcome(y, treated, participant, scenario, name="measure", unit="points") -> Outcome:
    """An outcome of anything that becomes arrays; clusters may have any names."""
    return Outcome(
        name,
        unit,
        np.array(y, dtype=float),
        np.array(treated, dtype=bool),
        *(np.unique(each, return_inverse=True)[1] for each in (participant, scenario)),
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
