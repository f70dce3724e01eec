"""Dealing: which condition and which scenarios the next place holds. Plain values only."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import lcm
from zlib import crc32

import numpy as np

from app.errors import DealingFailed
from policies import CONDITIONS, Scenario

LIST_LENGTH = 10
MOST_PER_GOAL = 3
MOST_PER_MAZE = 4
_SWAPS = 5000

Scenarios = tuple[Scenario, ...]


@dataclass(frozen=True)
class Place:
    """A place in the study before somebody has it: number, condition, scenarios in their order."""

    number: int
    condition: str
    scenarios: tuple[str, ...]


def deal_block(
    seed: int, stream: str, block: int, size: int, scenarios: Scenarios
) -> Iterator[Place]:
    """The places of one block: each condition equally often, in permuted order.

    Over the places of a stream, taken in order, the conditions differ by at most size / 2, and
    within a condition no scenario is ahead of another by more than one.
    """
    rng = np.random.default_rng([seed, crc32(stream.encode()), block])
    per_condition = size // len(CONDITIONS)
    dealt: Counter[str] = Counter()
    for offset, condition in enumerate(rng.permutation(CONDITIONS * per_condition).tolist()):
        rank = block * per_condition + dealt[condition]
        dealt[condition] += 1
        cycle, within = divmod(rank, lists_in_cycle(scenarios))
        lists = balanced_lists(scenarios, (seed, crc32(f"{stream}/{condition}".encode()), cycle))
        yield Place(block * size + offset, condition, lists[within])


def lists_in_cycle(scenarios: Scenarios) -> int:
    """After how many lists every scenario has been used equally often."""
    return lcm(len(scenarios), LIST_LENGTH) // LIST_LENGTH


@lru_cache(maxsize=16)
def balanced_lists(scenarios: Scenarios, seed: tuple[int, ...]) -> tuple[tuple[str, ...], ...]:
    """A cycle of lists of 10 different scenarios, cut one after the other from shuffled decks.

    Every list has each goal 1-3 times and each maze 1-4 times; DealingFailed when the pool
    allows no such lists.
    """
    rng = np.random.default_rng(seed)
    lists: list[list[Scenario]] = [[]]
    while len(lists) <= lists_in_cycle(scenarios):
        begun = lists.pop()
        lists.extend(_cut_deck(scenarios, begun, rng))
    return tuple(tuple(chosen[i].id for i in rng.permutation(LIST_LENGTH)) for chosen in lists[:-1])


def _cut_deck(
    scenarios: Scenarios, begun: list[Scenario], rng: np.random.Generator
) -> list[list[Scenario]]:
    """Finish the list begun and cut more from one shuffled deck; the last one is a list begun.

    Scenarios are swapped between lists until each list is balanced.
    """
    cards = [*begun, *(scenarios[i] for i in rng.permutation(len(scenarios)))]

    def lists_of(where: Iterable[int]) -> list[list[Scenario]]:
        return [cards[i * LIST_LENGTH : (i + 1) * LIST_LENGTH] for i in where]

    everywhere = range(len(cards) // LIST_LENGTH + 1)
    faults = sum(_faults(chosen, scenarios) for chosen in lists_of(everywhere))
    for one, other in rng.integers(len(begun), len(cards), (_SWAPS, 2)).tolist():
        if faults == 0:
            return lists_of(everywhere)
        concerned = {one // LIST_LENGTH, other // LIST_LENGTH}
        before = sum(_faults(chosen, scenarios) for chosen in lists_of(concerned))
        cards[one], cards[other] = cards[other], cards[one]
        after = sum(_faults(chosen, scenarios) for chosen in lists_of(concerned))
        if after > before:
            cards[one], cards[other] = cards[other], cards[one]
        else:
            faults += after - before
    raise DealingFailed(
        f"expected a pool from which lists of {LIST_LENGTH} can be drawn with each goal 1-3 and "
        f"each maze 1-4 times; the {len(scenarios)} scenarios given allow none"
    )


def _faults(chosen: Sequence[Scenario], scenarios: Scenarios) -> int:
    """How far a list is from balance: repetitions, too many uses, uses without room."""
    room = LIST_LENGTH - len(chosen)
    faults = len(chosen) - len(set(chosen))
    # A list begun must have room for all that is missing one by one: the card that brings both
    # a missing goal and a missing maze may not exist.
    missing = 0
    for key, most in (("goal", MOST_PER_GOAL), ("maze", MOST_PER_MAZE)):
        used = Counter(getattr(scenario, key) for scenario in chosen)
        missing += len({getattr(scenario, key) for scenario in scenarios} - set(used))
        faults += sum(max(0, uses - most) for uses in used.values())
    return faults + max(0, missing - room)
