"""Many people who arrive, 500 at once, in several processes on one database file.

Each process opens the study for itself, as a server does. Most people play as soon as they are
dealt a place; the others drop out, and half of those come back when everybody has arrived and
their places are late. Places are kept so briefly that the first are dealt again before that.
"""

import asyncio
import multiprocessing
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing
from dataclasses import dataclass
from itertools import repeat
from multiprocessing.synchronize import Barrier
from pathlib import Path
from typing import Any

import numpy as np
from sqlalchemy import Connection

from app import enrolment
from app.database import Database
from app.errors import PlaceReturned
from app.opening import open_database
from app.settings import Settings
from app.study import PARTICIPANT, SIMULATED, Study, load_study
from tests.app import people

PLAYS, RETURNS, LEAVES = range(3)
SHARES = (0.7, 0.15, 0.15)
AT_ONCE = 500
PLACE_S = 0.3
PATIENCE_S = 120

_together: Barrier
"""Where the processes wait for each other."""


@dataclass(frozen=True)
class Arrivals:
    """How many arrived, how many of them played in the end, and how soon all had been dealt."""

    people: int
    players: int
    seconds: float


def settings_of(file: Path, seed: int) -> Settings:
    """The study that they arrive at."""
    return Settings(database_url=f"sqlite:///{file}", seed=seed, place_minutes=PLACE_S / 60)


def arrive_at_once(settings: Settings, number: int, processes: int, seed: int) -> Arrivals:
    """Let people arrive, spread over processes that begin together."""
    context = multiprocessing.get_context("spawn")
    kinds = np.random.default_rng(seed).choice(3, number, p=SHARES)
    shares = [kinds[i::processes].tolist() for i in range(processes)]
    together = context.Barrier(processes, timeout=PATIENCE_S)
    with ProcessPoolExecutor(processes, context, _meet, (together,)) as pool:
        at_once = repeat(AT_ONCE // processes)
        times = list(pool.map(_take_part, repeat(settings), shares, at_once))
    seconds = max(dealt for _, dealt in times) - min(began for began, _ in times)
    return Arrivals(number, int((kinds != LEAVES).sum()), seconds)


def _meet(together: Barrier) -> None:
    global _together
    _together = together


def _take_part(settings: Settings, kinds: Sequence[int], at_once: int) -> tuple[float, float]:
    """One process's people; returns when they began to arrive and when the last was dealt."""
    try:
        study = load_study(settings)
        _together.wait()
        with closing(open_database(study)) as database:
            return asyncio.run(_Visitors(database, study).take_part(kinds, at_once))
    except BaseException:
        # The others need not wait for this one.
        _together.abort()
        raise


@dataclass(frozen=True)
class _Visitors:
    database: Database
    study: Study

    async def take_part(self, kinds: Sequence[int], at_once: int) -> tuple[float, float]:
        turns = asyncio.Semaphore(at_once)

        async def arrive_in_turn(kind: int) -> tuple[str, float]:
            async with turns:
                return await self.arrive(kind)

        # A server under load is not a new one: it has run each statement before.
        await self.arrive(PLAYS, SIMULATED)
        _together.wait()
        began = time.monotonic()
        arrived = await asyncio.gather(*map(arrive_in_turn, kinds))
        _together.wait()
        await asyncio.sleep(PLACE_S)
        late = [person for person, kind in zip(arrived, kinds, strict=True) if kind == RETURNS]
        await asyncio.gather(*(self.write(_come_back, token) for token, _ in late))
        return began, max(dealt for _, dealt in arrived)

    async def arrive(self, kind: int, stream: str = PARTICIPANT) -> tuple[str, float]:
        """Come to the trials and, perhaps, play; the session's token, and when it was dealt."""
        token = await self.write(people.consent, stream)
        for go_on in people.TO_THE_TRIALS:
            await self.write(go_on, token)
        dealt = time.monotonic()
        if kind == PLAYS:
            try:
                ticket = await self.database.read(lambda c: people.ticket(c, self.study, token))
                await self.write(people.play, token, ticket)
            except PlaceReturned:
                await self.write(_come_back, token)
        return token, dealt

    async def write(self, happen: Callable[..., Any], *arguments: object) -> Any:
        return await self.database.write(lambda c: happen(c, self.study, *arguments))


def _come_back(connection: Connection, study: Study, token: str) -> None:
    """Load the page and play before anybody else can be dealt the place."""
    enrolment.deal_again(connection, study, token)
    people.play(connection, study, token, people.ticket(connection, study, token))
