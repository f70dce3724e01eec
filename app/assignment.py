"""Dealing: which condition and which scenarios the next place holds. Plain values only."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import lcm
from typing import NamedTuple
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
    kinds = _kinds(scenarios)
    lists: list[list[int]] = [[]]
    while len(lists) <= lists_in_cycle(scenarios):
        begun = lists.pop()
        lists.extend(_cut_deck(kinds, begun, rng))
    return tuple(
        tuple(scenarios[chosen[i]].id for i in rng.permutation(LIST_LENGTH))
        for chosen in lists[:-1]
    )


class _Kind(NamedTuple):
    """Goals or mazes, numbered: which one each scenario has, how many, the most uses in a list.

    Numbers, because everybody who is being dealt a place waits while lists are cut.
    """

    of: list[int]
    number: int
    most: int


def _kinds(scenarios: Scenarios) -> tuple[_Kind, _Kind]:
    goals = sorted({scenario.goal for scenario in scenarios})
    mazes = sorted({scenario.maze for scenario in scenarios})
    return (
        _Kind([goals.index(scenario.goal) for scenario in scenarios], len(goals), MOST_PER_GOAL),
        _Kind([mazes.index(scenario.maze) for scenario in scenarios], len(mazes), MOST_PER_MAZE),
    )


def _cut_deck(
    kinds: tuple[_Kind, _Kind], begun: list[int], rng: np.random.Generator
) -> list[list[int]]:
    """Finish the list begun and cut more from one shuffled deck; the last one is a list begun.

    Scenarios, by their numbers, are swapped between lists until each list is balanced.
    """
    deck = len(kinds[0].of)
    cards = [*begun, *rng.permutation(deck).tolist()]

    def list_at(i: int) -> list[int]:
        return cards[i * LIST_LENGTH : (i + 1) * LIST_LENGTH]

    everywhere = range(len(cards) // LIST_LENGTH + 1)
    faults = [_faults(list_at(i), kinds) for i in everywhere]
    for swap in rng.integers(len(begun), len(cards), (_SWAPS, 2)):
        if not any(faults):
            return [list_at(i) for i in everywhere]
        one, other = swap.tolist()
        cards[one], cards[other] = cards[other], cards[one]
        after = {i: _faults(list_at(i), kinds) for i in (one // LIST_LENGTH, other // LIST_LENGTH)}
        if sum(after.values()) > sum(faults[i] for i in after):
            cards[one], cards[other] = cards[other], cards[one]
        else:
            for i, left in after.items():
                faults[i] = left
    raise DealingFailed(
        f"expected a pool from which lists of {LIST_LENGTH} can be drawn with each goal 1-3 and "
        f"each maze 1-4 times; the {deck} scenarios given allow none"
    )


def _faults(chosen: Sequence[int], kinds: tuple[_Kind, _Kind]) -> int:
    """How far a list is from balance: repetitions, too many uses, uses without room."""
    room = LIST_LENGTH - len(chosen)
    faults = len(chosen) - len(set(chosen))
    # A list begun must have room for all that is missing one by one: the card that brings both
    # a missing goal and a missing maze may not exist.
    missing = 0
    for of, number, most in kinds:
        uses = [0] * number
        for scenario in chosen:
            uses[of[scenario]] += 1
        missing += uses.count(0)
        faults += sum(times - most for times in uses if times > most)
    return faults + max(0, missing - room)
