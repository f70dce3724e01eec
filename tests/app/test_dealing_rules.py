"""Dealing, whatever people do: arrive, play, drop out, come back late, give up, withdraw."""

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from math import ceil
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings as effort
from hypothesis import strategies as st
from hypothesis.stateful import (
    Bundle,
    RuleBasedStateMachine,
    initialize,
    invariant,
    rule,
    run_state_machine_as_test,
)
from sqlalchemy import select

from app import enrolment, repository
from app.errors import AppError
from app.opening import open_database
from app.sessions import participant_of
from app.settings import Settings
from app.steps import ENDINGS, Step
from app.study import PARTICIPANT, SIMULATED, load_study
from app.tables import participants, places
from tests.app import dealing_bounds, people

STREAMS = (PARTICIPANT, SIMULATED)
KEPT = timedelta(minutes=30)
"""How long an unplayed place is kept."""


class Clock:
    """The server's clock, set by hand."""

    def __init__(self) -> None:
        self.time = datetime(2026, 1, 1, tzinfo=UTC)

    def __call__(self) -> datetime:
        return self.time


@dataclass
class Person:
    """Somebody at the trials, the ticket their page was loaded with, and when that was dealt."""

    id: int
    token: str
    ticket: str = ""
    dealt_at: datetime | None = None


class Dealing(RuleBasedStateMachine):
    """A study with people in it; after each of their steps the tables are looked at."""

    arrived = Bundle("arrived")

    def __init__(self, empty_database: Path, block_size: int, clock: Clock) -> None:
        super().__init__()
        self.block_size = block_size
        self.clock = clock
        self.folder = tempfile.TemporaryDirectory()
        self.file = Path(self.folder.name) / "study.sqlite"
        shutil.copy(empty_database, self.file)

    @initialize(seed=st.integers(0, 2**32 - 1))
    def open_study(self, seed: int) -> None:
        settings = Settings(
            database_url=f"sqlite:///{self.file}",
            seed=seed,
            block_size=self.block_size,
            place_minutes=KEPT.total_seconds() / 60,
        )
        self.study = load_study(settings)
        self.database = open_database(self.study)
        self.before: dict[tuple[str, int], Any] = {}
        self.places = self.before
        self.ever_dealt: dict[str, set[int]] = {stream: set() for stream in STREAMS}

    def teardown(self) -> None:
        self.database.close()
        self.folder.cleanup()

    def do(self, happen, *arguments):
        """Let something happen in a transaction of its own, then look at the tables."""
        try:
            return self.database.submit(lambda c: happen(c, self.study, *arguments)).result()
        finally:
            self.look()

    def look(self) -> None:
        rows = self.database.read_now(lambda c: c.execute(select(places)).all())
        self.before = self.places
        self.places = {(row.stream, row.number): row for row in rows}
        for row in rows:
            if row.dealt_at is not None:
                self.ever_dealt[row.stream].add(row.number)

    def step_of(self, participant_id: int) -> str:
        step = select(participants.c.step).where(participants.c.id == participant_id)
        found: str = self.database.read_now(lambda c: c.scalars(step).one())
        return found

    def place_of(self, person: Person) -> Any:
        return next((row for row in self.places.values() if row.participant_id == person.id), None)

    # --- what people do ------------------------------------------------------------------------

    @rule(target=arrived, stream=st.sampled_from(STREAMS))
    def arrive(self, stream: str) -> Person:
        token = self.do(people.reach_trials, stream)
        person = Person(self.database.read_now(lambda c: participant_of(c, token).id), token)
        self.keep_ticket(person)
        return person

    @rule(person=arrived)
    def load_the_page_again(self, person: Person) -> None:
        if self.step_of(person.id) == Step.TRIALS:
            self.do(enrolment.deal_again, person.token)
            self.keep_ticket(person)

    def keep_ticket(self, person: Person) -> None:
        ticket = self.database.read_now(lambda c: people.ticket(c, self.study, person.token))
        person.ticket, person.dealt_at = ticket, self.place_of(person).dealt_at

    @rule(person=arrived)
    def play_the_first_frame(self, person: Person) -> None:
        place = self.place_of(person)
        theirs = place and (place.played_at or place.dealt_at == person.dealt_at)
        with refused(unless=theirs and self.step_of(person.id) == Step.TRIALS):
            self.do(people.play, person.token, person.ticket)
            assert self.place_of(person).played_at is not None

    @rule(minutes=st.sampled_from([1, 29, 31, 600]))
    def let_time_pass(self, minutes: int) -> None:
        self.clock.time += timedelta(minutes=minutes)
        self.look()

    @rule(person=arrived)
    def give_up(self, person: Person) -> None:
        with refused(unless=self.step_of(person.id) not in ENDINGS):
            self.do(enrolment.fail, person.token)

    @rule(person=arrived)
    def withdraw(self, person: Person) -> None:
        with refused(unless=self.step_of(person.id) != Step.WITHDRAWN):
            self.do(enrolment.withdraw, person.token)

    # --- what must hold ------------------------------------------------------------------------

    def newly_dealt(self) -> Iterator[Any]:
        for key, row in self.places.items():
            was = self.before.get(key)
            if row.dealt_at is not None and (was is None or was.dealt_at != row.dealt_at):
                yield row

    def is_late(self, place: Any) -> bool:
        """Whether a place was dealt too long ago without being played."""
        held = place.dealt_at is not None and place.played_at is None
        return held and self.clock.time - place.dealt_at > KEPT

    def dealt(self, stream: str) -> list[Any]:
        return [self.places[stream, number] for number in sorted(self.ever_dealt[stream])]

    @invariant()
    def places_ever_dealt_are_the_first_ones(self) -> None:
        for stream in STREAMS:
            dealt, rows = self.ever_dealt[stream], [s for s, _ in self.places if s == stream]
            assert dealt == set(range(len(dealt)))
            assert len(rows) == ceil(len(dealt) / self.block_size) * self.block_size

    @invariant()
    def conditions_differ_by_at_most_half_a_block(self) -> None:
        for stream in STREAMS:
            assert dealing_bounds.arm_difference(self.dealt(stream)) <= self.block_size / 2

    @invariant()
    def no_scenario_is_ahead_of_another_by_more_than_one(self) -> None:
        for stream in STREAMS:
            assert dealing_bounds.scenario_lead(self.dealt(stream), self.study.pool.scenarios) <= 1

    @invariant()
    def each_list_is_balanced(self) -> None:
        assert dealing_bounds.unbalanced(self.places.values(), self.study.pool.scenarios) == []

    @invariant()
    def a_participant_has_at_most_one_place_and_a_place_at_most_one_participant(self) -> None:
        assert self.database.read_now(dealing_bounds.misfits) == []

    @invariant()
    def a_place_keeps_its_list_and_once_played_its_participant(self) -> None:
        for key, was in self.before.items():
            row = self.places[key]
            assert (row.condition, row.scenarios) == (was.condition, was.scenarios)
            assert was.played_at is None or row == was

    @invariant()
    def places_given_back_are_dealt_before_new_ones(self) -> None:
        for place in self.newly_dealt():
            stream = [row for row in self.places.values() if row.stream == place.stream]
            assert all(row.number > place.number for row in stream if row.dealt_at is None)
            assert not any(self.is_late(row) for row in stream)

    @invariant()
    def nobody_loses_an_unplayed_place_before_its_time(self) -> None:
        for key, was in self.before.items():
            if was.participant_id not in (None, self.places[key].participant_id):
                assert self.step_of(was.participant_id) in ENDINGS or self.is_late(was)

    @invariant()
    def who_ends_without_having_played_gives_the_place_back(self) -> None:
        unplayed = [row for row in self.places.values() if row.dealt_at and not row.played_at]
        assert not any(self.step_of(row.participant_id) in ENDINGS for row in unplayed)


@contextmanager
def refused(unless: object) -> Iterator[None]:
    """What happens in here is possible only under a condition."""
    with nullcontext() if unless else pytest.raises(AppError):
        yield


@pytest.mark.parametrize("block_size", [2, 4, 10])
def test_the_bounds_of_the_dealing_hold_whatever_people_do(empty_database, monkeypatch, block_size):
    clock = Clock()
    monkeypatch.setattr(repository, "now", clock)

    class OfThisBlockSize(Dealing):
        def __init__(self) -> None:
            super().__init__(empty_database, block_size, clock)

    run_state_machine_as_test(
        OfThisBlockSize, settings=effort(max_examples=15, stateful_step_count=40, deadline=None)
    )
