"""How places were dealt, read from the tables alone, in the terms of the bounds they must keep."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Any, Protocol

from sqlalchemy import Connection, select

from app.study import Study
from app.tables import events, participants, places, trials
from policies import CONDITIONS, Scenario


class Place(Protocol):
    """A place as a row of the table or as it is drawn."""

    @property
    def number(self) -> int: ...
    @property
    def condition(self) -> str: ...
    @property
    def scenarios(self) -> Sequence[str]: ...


def arm_difference(dealt: Iterable[Place]) -> int:
    """By how many places one condition was ever ahead of the other; at most half a block."""
    steps = (1 if place.condition == CONDITIONS[0] else -1 for place in dealt)
    return max(map(abs, accumulate(steps)), default=0)


def scenario_lead(dealt: Iterable[Place], scenarios: Iterable[Scenario]) -> int:
    """By how many lists of a condition one scenario was ever ahead of another; at most 1."""
    none = dict.fromkeys((scenario.id for scenario in scenarios), 0)
    used = {condition: Counter(none) for condition in CONDITIONS}
    lead = 0
    for place in dealt:
        counts = used[place.condition]
        counts.update(place.scenarios)
        lead = max(lead, max(counts.values()) - min(counts.values()))
    return lead


def unbalanced(dealt: Iterable[Place], scenarios: Iterable[Scenario]) -> list[int]:
    """Places whose list is not 10 scenarios, each goal 1-3 times and each maze 1-4 times."""
    by_id = {scenario.id: scenario for scenario in scenarios}
    all_goals = {scenario.goal for scenario in by_id.values()}
    all_mazes = {scenario.maze for scenario in by_id.values()}

    def balanced(chosen: Sequence[str]) -> bool:
        goals = Counter(by_id[one].goal for one in chosen)
        mazes = Counter(by_id[one].maze for one in chosen)
        return (
            len(set(chosen)) == len(chosen) == 10
            and (set(goals), set(mazes)) == (all_goals, all_mazes)
            and max(goals.values()) <= 3
            and max(mazes.values()) <= 4
        )

    return [place.number for place in dealt if not balanced(place.scenarios)]


def misfits(connection: Connection) -> list[str]:
    """Places and people that do not fit each other one to one, a line each."""
    rows = connection.execute(select(places)).all()
    holders = Counter(row.participant_id for row in rows if row.participant_id is not None)
    playing = set(connection.scalars(select(trials.c.participant_id)))
    owners = {row.participant_id for row in rows if row.played_at is not None}
    return [
        *(f"participant {one} has {n} places" for one, n in holders.items() if n > 1),
        *(f"participant {one} played, and has no place" for one in sorted(playing - owners)),
        *(
            f"place {row.number} of {row.stream} is neither free nor somebody's"
            for row in rows
            if len({row.participant_id is None, row.dealt_at is None}) > 1
            or (row.participant_id is None and row.played_at is not None)
        ),
    ]


@dataclass(frozen=True)
class Dealings:
    """What was dealt in a stream: place numbers as logged, in the order of the transactions."""

    numbers: Sequence[int]
    places: Sequence[Any]

    @property
    def again(self) -> int:
        """How often a place that had been given back was dealt."""
        return len(self.numbers) - len(self.places)

    @property
    def out_of_order(self) -> int:
        """How many places were dealt for the first time before or after their turn."""
        firsts = dict.fromkeys(self.numbers)
        return sum(number != turn for turn, number in enumerate(firsts))


def read_dealings(connection: Connection, stream: str) -> Dealings:
    """The dealings of a stream from which nobody has withdrawn: who does leaves no log."""
    logged = connection.scalars(
        select(events.c.details)
        .join(participants, participants.c.id == events.c.participant_id)
        .where(events.c.type == "dealt", participants.c.stream == stream)
        .order_by(events.c.id)
    )
    numbers = [details["place"] for details in logged]
    of_stream = select(places).where(places.c.stream == stream).order_by(places.c.number)
    ever = set(numbers)
    return Dealings(numbers, [row for row in connection.execute(of_stream) if row.number in ever])


@dataclass(frozen=True)
class Bound:
    """Something measured, and the most it may be."""

    name: str
    measured: int
    most: int

    @property
    def holds(self) -> bool:
        return self.measured <= self.most


def bounds(
    connection: Connection, dealings: Dealings, study: Study, block_size: int, players: int
) -> list[Bound]:
    """Every bound of the dealing to people of whom so many play."""
    dealt, scenarios = dealings.places, study.pool.scenarios
    played = sum(place.played_at is not None for place in dealt)
    return [
        Bound("places between conditions, any prefix", arm_difference(dealt), block_size // 2),
        Bound("lists between scenarios, any prefix", scenario_lead(dealt, scenarios), 1),
        Bound("lists out of balance", len(unbalanced(dealt, scenarios)), 0),
        Bound("places dealt out of order", dealings.out_of_order, 0),
        Bound("people and places that do not fit", len(misfits(connection)), 0),
        Bound("players without a place", players - played, 0),
    ]
