"""The framework comparison (paper, 4.2): every framework plays every pair of every world."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import get_args

from policies.errors import ModelError
from policies.experiments.frameworks import ACTIONS, FRAMEWORKS, PAPER, play
from policies.experiments.parallel import as_they_finish
from policies.experiments.store import Store
from policies.experiments.worlds import Pair, Test, World, draw_pairs
from policies.lmdp import SEARCHES, Search
from policies.maze import format_maze
from policies.measures import measure_legibility
from policies.observer import action_beliefs
from policies.polmdp import legible_rewards
from policies.pool import content_hash
from policies.pool_rule import generator
from policies.solvers import distances, goal_values

COLUMNS = (
    *("world", "states", "goals"),
    *("pair", "start", "goal", "distance", "framework"),
    *("goal_solves_s", "planning_s"),
    *("polmdp", "polmdp_per_step", "lmdp"),
    *("steps", "arrived", "timed_out"),
)
"""Of a row: distance in moves; times as in Played; the measures as in Legibility; `arrived`
(within 4 x distance / .85 steps) and `timed_out` as 0 or 1."""


@dataclass(frozen=True)
class Comparison:
    """What is run: the test, pairs a world, L-MDP's mode and effort, time limit a pair, the seed.

    The limit counts seconds of L-MDP's solving and searching for one pair.
    """

    test: Test
    pairs: int = 250
    simulations: int = 10_000
    limit_s: float = 60.0
    mode: str = "miura"
    seed: int = 2209

    def __post_init__(self) -> None:
        if self.test not in get_args(Test):
            raise ModelError(f"expected a test in {', '.join(get_args(Test))}; came {self.test!r}")
        if self.pairs < 1:
            raise ModelError(f"expected at least 1 pair a world, came {self.pairs}")
        if self.mode not in SEARCHES:
            raise ModelError(f"expected mode in {', '.join(SEARCHES)}; came {self.mode!r}")
        _ = self.search  # which checks the others

    @property
    def search(self) -> Search:
        """L-MDP's parameters."""
        return replace(
            SEARCHES[self.mode],
            simulations=self.simulations,
            time_limit_s=self.limit_s,
            actions=PAPER.actions,
        )


def open_comparison(
    folder: Path, worlds: Sequence[World], comparison: Comparison, *, resume: bool = False
) -> Store:
    """The result files of a run, named by its test; other mazes are another run."""
    mazes = {world.name: content_hash(format_maze(world.maze)) for world in worlds}
    parameters = {**asdict(comparison), "mazes": mazes}
    return Store(folder, comparison.test, parameters, COLUMNS, resume=resume)


def compare_frameworks(
    worlds: Sequence[World],
    comparison: Comparison,
    store: Store,
    workers: int = 1,
    cluster: str | None = None,
    progress: Callable[[int, int], None] = lambda _done, _all: None,
) -> None:
    """Append the rows that the store does not hold yet, a pair's as soon as they are there.

    The same rows, times apart, whatever the number of workers and on a dask cluster (the address
    of its scheduler). `progress` hears how many of all pairs are done.
    """
    stored = store.done(("world", "pair", "framework"))
    pairs = [(world, draw_pairs(world, comparison.pairs, comparison.seed)) for world in worlds]
    # One pair of every world after another: a run that is stopped has something of each.
    units = [
        (world, drawn[number], missing, comparison)
        for number in range(comparison.pairs)
        for world, drawn in pairs
        if (missing := [f for f in FRAMEWORKS if (world.name, str(number), f) not in stored])
    ]
    total = comparison.pairs * len(worlds)
    done = total - len(units)
    progress(done, total)
    for rows in as_they_finish(play_pair, units, workers, cluster):
        store.append(rows)
        done += 1
        progress(done, total)


def play_pair(
    world: World, pair: Pair, frameworks: Sequence[str], comparison: Comparison
) -> list[dict[str, object]]:
    """The rows of a pair, one a framework, by `COLUMNS`."""
    maze, n = world.maze, world.maze.goal_index(pair.goal)
    distance = int(distances(maze)[n, pair.start])
    q = goal_values(maze, PAPER.gamma, ACTIONS)
    r_leg = legible_rewards(q, PAPER.beta)
    rows: list[dict[str, object]] = []
    for framework in frameworks:
        rng = generator(comparison.seed, world.name, pair.number, framework)
        played = play(framework, maze, pair, comparison.search, rng)
        way = played.rollout
        beliefs = action_beliefs(maze, q, way.states, way.actions, ACTIONS)
        seen = measure_legibility(way, n, r_leg, beliefs, PAPER.gamma)
        values = (
            *(world.name, maze.states, len(maze.goals)),
            *(pair.number, pair.start, pair.goal, distance, framework),
            *(played.goal_solves_s, played.planning_s),
            *(seen.polmdp, seen.polmdp_per_step, seen.lmdp),
            *(way.steps, int(way.arrived), int(played.timed_out)),
        )
        rows.append(dict(zip(COLUMNS, values, strict=True)))
    return rows
