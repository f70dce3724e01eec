"""How long `export` takes and how much memory, of as many participants as asked for.

Example: python -m tests.benchmarks.export --participants 10000

Each has answered ten trials and left fifteen events. The command runs in a process of its own, its
start included.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from datetime import timedelta
from pathlib import Path

from sqlalchemy import Connection, insert

from app.opening import open_database
from app.repository import now
from app.settings import Settings
from app.study import PARTICIPANT, Study, load_study
from app.tables import demographics, events, participants, places, trials
from tests import messages

EACH, EVENTS = 10, 15
ON_THE_WAY = ("described", "instructed", "passed_control")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--participants", type=int, default=10_000)
    number = parser.parse_args().participants
    with tempfile.TemporaryDirectory() as made:
        url = f"sqlite:///{made}/study.sqlite"
        study = load_study(Settings(database_url=url))
        database = open_database(study)
        database.submit(lambda connection: fill(connection, study, number)).result()
        database.close()
        seconds, mebibytes = measured(url, Path(made) / "export")
    print(f"{number * EVENTS:,} events: {seconds:.1f} s, {mebibytes:.0f} MiB at most")


def fill(connection: Connection, study: Study, number: int) -> None:
    """Add so many participants who have completed the study."""
    began = now()
    recorded = {"study_hash": study.hash, "app_version": "0"}
    stimuli = sorted(study.pool.stimuli)
    for of in range(1, number + 1):
        at = began + timedelta(seconds=of)
        person = {"id": of, "pseudonym": f"P{of}", "stream": PARTICIPANT, "step": "completed"}
        times = {"consented_at": at, "finished_at": at + timedelta(minutes=10)}
        connection.execute(insert(participants), {**person, **times, **recorded})
        answers = {**messages.ABOUT_ME, "age": 31}
        connection.execute(insert(demographics), {"participant_id": of, **answers})
        place = {"stream": PARTICIPANT, "number": of, "participant_id": of, "scenarios": []}
        dealt = {"dealt_at": at + timedelta(seconds=90), "played_at": at + timedelta(seconds=99)}
        connection.execute(insert(places), {**place, **dealt, "condition": "optimal"})
        of_person = {"participant_id": of, **recorded}
        connection.execute(
            insert(trials),
            [
                {
                    **of_person,
                    "trial_index": index,
                    "stimulus": stimuli[(of + index) % len(stimuli)],
                    "step_ms": 1000,
                    "length_ms": 40_000,
                    "lead_in_ms": 1500,
                    "played_at": at + timedelta(seconds=60 + 40 * index),
                    "position_ms": 0,
                    "stopped_at": at + timedelta(seconds=80 + 40 * index),
                    "stop_time_ms": 12_345.6 + index,
                    "reached_end": False,
                    "pauses": 0,
                    "paused_ms": 0,
                    "focus_losses": 0,
                    "frames_dropped": 1,
                    "reduced_motion": False,
                    "answered_at": at + timedelta(seconds=95 + 40 * index),
                    "guess": "ABCDEF"[(of + index) % 6],
                    "confidence": 5,
                    "guess_latency_ms": 1200.5,
                    "confidence_latency_ms": 800,
                    "pointer_moved": True,
                }
                for index in range(1, EACH + 1)
            ],
        )
        connection.execute(
            insert(events),
            [
                {
                    **of_person,
                    "message_key": f"{of}-{ordinal}",
                    "ordinal": ordinal,
                    "type": ON_THE_WAY[ordinal] if ordinal < len(ON_THE_WAY) else "resized",
                    "server_time": at + timedelta(seconds=20 + 5 * ordinal),
                    "client_time_ms": 1000.5 * ordinal,
                    "details": {"viewport_width": 1280, "viewport_height": 720, "zoom": 1.25},
                }
                for ordinal in range(EVENTS)
            ],
        )


def measured(url: str, folder: Path) -> tuple[float, float]:
    """Export in a process of its own; return wall seconds and peak resident MiB."""
    start = time.perf_counter()
    child = subprocess.Popen(
        [sys.executable, "-m", "app.cli", "export", "--to", str(folder)],
        env={**os.environ, "GOALGUESS_DATABASE_URL": url},
    )
    _, status, usage = os.wait4(child.pid, 0)
    if status:
        raise SystemExit("export failed")
    return time.perf_counter() - start, usage.ru_maxrss / 1024


if __name__ == "__main__":
    main()
