"""Kills the server in the middle of many answers and counts what was acknowledged and is lost.

Example: python -m tests.benchmarks.kill --runs 10 --participants 200

In each run all participants take part at once; at a random moment the server gets SIGKILL, is
started again on the same database, and everybody goes on. Prints a line a run; exit code 1 if an
acknowledged answer is missing, changed or there twice, or somebody did not get to the end.
"""

import argparse
import asyncio
import sqlite3
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from httpx2 import AsyncClient, Response

from app.bots.crowd import Outcome, draw_bots, simulate
from app.bots.kinds import read_mix
from tests.server_process import ServerProcess

MIX = "attentive=4,offline=1,double_clicking=1,two_tabs=1,reloading=1"
ROUNDS = 10
_STORED = """
    SELECT recruiter_id, trial_index, guess, confidence, stop_time_ms
    FROM trials JOIN recruits USING (participant_id) WHERE answered_at IS NOT NULL
"""
_LOGGED = """
    SELECT recruiter_id, trial_index FROM events JOIN recruits USING (participant_id)
    WHERE type = 'answered'
"""

# Some fail the control question and are screened out: that is an end too.
_ENDED = "SELECT count(*) FROM participants WHERE step IN ('completed', 'screened_out')"


@dataclass(frozen=True)
class Run:
    """One run: answers acknowledged before the kill and in all, and what became of them."""

    before: int
    acknowledged: int
    lost: int
    double: int
    unfinished: int

    @property
    def holds(self) -> bool:
        """Whether every promise was kept."""
        return not (self.lost or self.double or self.unfinished)


def run(folder: Path, participants: int, seed: int) -> Run:
    """Let participants take part at once and kill the server between a fifth and four fifths."""
    database = folder / f"kill-{seed}.sqlite"
    rng = np.random.default_rng(seed)
    kill_at = int(rng.uniform(0.2, 0.8) * ROUNDS * participants)
    bots = draw_bots(participants, seed, read_mix(MIX))
    with ServerProcess(database) as server:
        heard = _Heard(server, kill_at)
        outcomes = asyncio.run(simulate(heard.new_client, bots, at_once=participants))
    return check(database, outcomes, heard.before)


class _Heard:
    """Counts the answers acknowledged to all browsers, and kills the server at one of them."""

    def __init__(self, server: ServerProcess, kill_at: int) -> None:
        self.before = 0
        self._server = server
        self._kill_at = kill_at

    def new_client(self) -> AsyncClient:
        return AsyncClient(
            base_url=self._server.url,
            follow_redirects=True,
            timeout=30,
            event_hooks={"response": [self._hear]},
        )

    async def _hear(self, reply: Response) -> None:
        if self.before == self._kill_at or not reply.url.path.endswith("/answered"):
            return
        self.before += reply.status_code == 200
        if self.before == self._kill_at:
            self._server.kill()
            self._server.start()


def check(database: Path, outcomes: Sequence[Outcome], before: int) -> Run:
    """Compare what participants were told with what the file holds."""
    with sqlite3.connect(database) as connection:
        stored = {(who, at): facts for who, at, *facts in connection.execute(_STORED)}
        rows = Counter((who, at) for who, at, *_ in connection.execute(_STORED))
        logged = Counter(connection.execute(_LOGGED).fetchall())
        (ended,) = connection.execute(_ENDED).fetchone()
    told = {
        (outcome.bot.recruiter_id, index): [answer.guess, answer.confidence, answer.stop_time_ms]
        for outcome in outcomes
        for index, answer in outcome.answers.items()
    }
    lost = sum(stored.get(key) != facts for key, facts in told.items())
    double = sum(n > 1 for n in rows.values()) + sum(n > 1 for n in logged.values())
    return Run(before, len(told), lost, double, unfinished=len(outcomes) - ended)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--participants", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    print(f"{'run':>4} {'killed after':>13} {'acknowledged':>13} {'lost':>5} {'double':>7} stuck")
    runs = []
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(given.seed, given.seed + given.runs):
            one = run(Path(folder), given.participants, seed)
            runs.append(one)
            print(
                f"{seed:4} {one.before:13,} {one.acknowledged:13,} {one.lost:5} {one.double:7} "
                f"{one.unfinished:5}"
            )
    if not all(one.holds for one in runs):
        sys.exit("Something that was acknowledged is not as it was.")


if __name__ == "__main__":
    main()
