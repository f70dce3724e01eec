"""How long `analyse` takes and how much memory, on a CSV of as many trials as asked for.

Example: python -m tests.benchmarks.analysis --trials 1000000

Simulates participants of ten trials each from the crossed model and runs the command in a process
of its own, its start included: without --to, and with the whole report.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import polars as pl

from analysis.crossed_model import Spread, confidence_model, correct_model, halves, simulate

EACH = 10
SPREAD = Spread(0.8, 0.5, 0.4)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--trials", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        path = Path(made) / "trials.csv"
        write_trials(given.trials // EACH, np.random.default_rng(given.seed), path)
        for name, further in (
            ("printed", []),
            ("whole report", ["--to", str(Path(made) / "report")]),
        ):
            seconds, mebibytes = measured(["analyse", str(path), *further])
            print(f"{given.trials:,} trials, {name}: {seconds:.1f} s, {mebibytes:.0f} MiB at most")


def measured(arguments: list[str]) -> tuple[float, float]:
    """Run the command in a process of its own; return wall seconds and peak resident MiB."""
    start = time.perf_counter()
    child = subprocess.Popen(
        [sys.executable, "-m", "analysis", *arguments], stdout=subprocess.DEVNULL
    )
    _, status, usage = os.wait4(child.pid, 0)
    if status:
        raise SystemExit("analyse failed")
    return time.perf_counter() - start, usage.ru_maxrss / 1024


def write_trials(participants: int, rng: np.random.Generator, path: Path) -> None:
    """Write the trials of a study in which everybody answered all of theirs."""
    design = halves(participants, EACH)
    given = simulate(correct_model(SPREAD, 0.85, 0.7), design, rng)
    confidence = simulate(confidence_model(SPREAD), design, rng).y
    length_s = 15.0 + given.scenario % 12
    seen = rng.beta(4 - given.treated, 2)
    pl.DataFrame(
        {
            "participant": given.participant,
            "condition": np.where(given.treated, "polmdp", "optimal"),
            "scenario": given.scenario,
            "trial_index": np.tile(np.arange(1, EACH + 1), participants),
            "correct": given.y == 1,
            "stop_time_s": np.round(length_s * seen, 3),
            "length_s": length_s,
            "confidence": confidence.astype(np.int64),
        }
    ).write_csv(path)


if __name__ == "__main__":
    main()
