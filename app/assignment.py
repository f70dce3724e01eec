"""Dealing: which condition and which scenarios the next place holds. Plain values only."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import lcm
from zlib import crc32

import numpy as np

from app.errors import DealingFailed
from policies import CONDITIONS, Scenario

LIST_LENGTH = 10
GOAL_USES = range(1, 4)
MAZE_USES = range(1, 5)
_TRIES = 300

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
    lists: list[Scenarios] = []
    begun: Scenarios = ()
    while len(lists) < lists_in_cycle(scenarios):
        for _ in range(_TRIES):
            cut = _cut_deck(scenarios, begun, rng)
            if cut:
                break
        else:
            raise DealingFailed(
                f"expected a pool from which lists of {LIST_LENGTH} can be drawn with each goal "
                f"1-3 and each maze 1-4 times; the {len(scenarios)} scenarios given allow none"
            )
        lists.extend(cut[0])
        begun = cut[1]
    return tuple(tuple(chosen[i].id for i in rng.permutation(LIST_LENGTH)) for chosen in lists)


def _cut_deck(
    scenarios: Scenarios, begun: Scenarios, rng: np.random.Generator
) -> tuple[list[Scenarios], Scenarios] | None:
    """Finish the list begun and cut more from one deck; what is left begins the next list."""
    lists: list[Scenarios] = []
    left = scenarios
    while len(begun) + len(left) >= LIST_LENGTH:
        chosen = _complete(begun, left, scenarios, rng)
        if chosen is None:
            return None
        lists.append(chosen)
        used = set(chosen) - set(begun)
        left = tuple(s for s in left if s not in used)
        begun = ()
    return (lists, left) if _may_begin(left, scenarios) else None


def _complete(
    begun: Scenarios, left: Scenarios, scenarios: Scenarios, rng: np.random.Generator
) -> Scenarios | None:
    """A balanced list that starts with `begun` and takes the rest, all different, from `left`."""
    fresh = [s for s in left if s not in begun]
    wanted = LIST_LENGTH - len(begun)
    if len(fresh) < wanted:
        return None
    for _ in range(_TRIES):
        drawn = rng.choice(len(fresh), wanted, replace=False)
        chosen = (*begun, *(fresh[i] for i in drawn))
        if all(set(counts.values()) <= set(uses) for counts, uses in _uses(chosen, scenarios)):
            return chosen
    return None


def _may_begin(begun: Scenarios, scenarios: Scenarios) -> bool:
    """Whether a list can still become balanced: nothing too often, room for what is missing."""
    room = LIST_LENGTH - len(begun)
    return all(
        max(counts.values()) <= uses[-1] and sum(n == 0 for n in counts.values()) <= room
        for counts, uses in _uses(begun, scenarios)
    )


def _uses(chosen: Sequence[Scenario], scenarios: Scenarios) -> Iterator[tuple[Counter[str], range]]:
    """How often each goal and each maze is among the chosen, and how often it may be."""
    for key, uses in (("goal", GOAL_USES), ("maze", MAZE_USES)):
        counts = Counter(dict.fromkeys((getattr(s, key) for s in scenarios), 0))
        counts.update(getattr(s, key) for s in chosen)
        yield counts, uses
