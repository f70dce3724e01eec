"""Answers of many participants, in a process of its own in which SQLite is recorded.

The journal holds, in their order, what was done to each file and which answers were acknowledged.
"""

import asyncio
import multiprocessing
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import AbstractContextManager, closing, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np
from sqlalchemy import Engine, event

from app import enrolment
from app.database import Database
from app.opening import open_database
from app.sessions import participant_of
from app.settings import Settings
from app.sqlite import sqlite_engine
from app.study import Study, load_study
from tests.app import people
from tests.app.recorded_sqlite import Entry, record_sqlite

FILE = "study.sqlite"
AT_ONCE = 8


class Acknowledged(NamedTuple):
    """An answer of which a participant was told that it is stored."""

    participant: int
    trial_index: int
    stop_time_ms: float
    guess: str
    confidence: int


Journal = Sequence[Entry | Acknowledged]


def record_answers(folder: Path, visitors: int, synchronous: str | None = None) -> Journal:
    """Let people visit the study and answer all its trials; what happened meanwhile, in order.

    `synchronous` has SQLite sync otherwise than the study has it.
    """
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as process:
        return process.submit(_record, folder, visitors, synchronous).result()


def _record(folder: Path, visitors: int, synchronous: str | None) -> Journal:
    journal: list[Entry | Acknowledged] = []
    record_sqlite(journal.append)
    study = load_study(Settings(database_url=f"sqlite:///{folder / FILE}", seed=1))
    with (
        _synced(synchronous) if synchronous else nullcontext(),
        closing(open_database(study)) as database,
        ThreadPoolExecutor(AT_ONCE) as at_once,
    ):
        list(at_once.map(_Study(study, database, journal.append).visit, range(visitors)))
    return journal


def _synced(synchronous: str) -> AbstractContextManager[object]:
    def engine_synced(url: str, begin: str) -> Engine:
        engine = sqlite_engine(url, begin)
        pragma = f"PRAGMA synchronous={synchronous}"
        event.listen(engine, "connect", lambda connection, _record: connection.execute(pragma))
        return engine

    return patch("app.database.sqlite_engine", engine_synced)


@dataclass(frozen=True)
class _Study:
    study: Study
    database: Database
    acknowledge: Callable[[Acknowledged], None]

    def visit(self, seed: int) -> None:
        """Take part; every sixth visitor withdraws, which empties the write-ahead log."""
        token = self.write(people.reach_trials).result()
        if seed % 6 == 5:
            self.write(enrolment.withdraw, token).result()
            asyncio.run(self.database.forget_deleted())
            return
        participant = self.database.read_now(lambda c: participant_of(c, token).id)
        rng = np.random.default_rng(seed)
        for index in range(1, self.study.trials + 1):
            stop_time_ms = round(rng.uniform(0, 5000), 1)
            guess, confidence = "ABCDEF"[rng.integers(6)], int(rng.integers(1, 8))
            answer = Acknowledged(participant, index, stop_time_ms, guess, confidence)
            self.answer(token, answer)

    def answer(self, token: str, answer: Acknowledged) -> None:
        """Play, stop and answer a trial; acknowledged at the moment the answer is written."""
        ticket = self.database.read_now(lambda c: people.ticket(c, self.study, token))
        _, index, stop_time_ms, guess, confidence = answer
        self.write(people.play, token, ticket, index).result()
        self.write(people.stop, token, index, stop_time_ms).result()
        stored = self.write(people.answer, token, index, stop_time_ms, guess, confidence)
        stored.add_done_callback(lambda _stored: self.acknowledge(answer))
        stored.result()

    def write(self, happen: Callable[..., Any], *arguments: object) -> Future[Any]:
        return self.database.submit(lambda c: happen(c, self.study, *arguments))
