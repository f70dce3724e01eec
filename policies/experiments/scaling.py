"""The framework comparison (paper, 4.2): every framework plays every pair of every world."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from pathlib import Path

from policies.errors import ModelError
from policies.experiments.authors import play_and_measure
from policies.experiments.comparison import Comparison
from policies.experiments.frameworks import measure, play, warm_up
from policies.experiments.parallel import as_they_finish
from policies.experiments.store import Store
from policies.experiments.worlds import Pair, World, draw_pairs
from policies.maze import ACTION_SETS, format_maze
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
(within the moves allowed) and `timed_out` as 0 or 1."""


def open_comparison(
    folder: Path, worlds: Sequence[World], comparison: Comparison, *, resume: bool = False
) -> Store:
    """The result files of a run, by the comparison's name; other mazes or pairs are another run."""
    mazes = {world.name: content_hash(format_maze(world.maze)) for world in worlds}
    listed = {world.name: content_hash(str(world.pairs)) for world in worlds if world.pairs}
    parameters = {**asdict(comparison), "mazes": mazes, "listed_pairs": listed}
    return Store(folder, comparison.name, parameters, COLUMNS, resume=resume)


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
    pairs = [(world, pair) for world in worlds for pair in pairs_of(world, comparison)]
    # One pair of every world after another: a run that is stopped has something of each.
    pairs.sort(key=lambda unit: unit[1].number)
    units = [
        (replace(world, pairs=None), pair, missing, comparison)
        for world, pair in pairs
        if (
            missing := [
                framework
                for framework in comparison.frameworks
                if (world.name, str(pair.number), framework) not in stored
            ]
        )
    ]
    total = len(pairs)
    done = total - len(units)
    progress(done, total)
    for rows in as_they_finish(play_pair, units, workers, cluster):
        store.append(rows)
        done += 1
        progress(done, total)


def pairs_of(world: World, comparison: Comparison) -> Sequence[Pair]:
    """The pairs that are listed for a world, else drawn ones."""
    if world.pairs is not None:
        return world.pairs
    if comparison.pairs is None:
        raise ModelError(f"{world.name}: expected listed pairs, or how many to draw")
    return draw_pairs(world, comparison.pairs, comparison.seed)


def play_pair(
    world: World, pair: Pair, frameworks: Sequence[str], comparison: Comparison
) -> list[dict[str, object]]:
    """The rows of a pair, one a framework, by `COLUMNS`."""
    maze, n = world.maze, world.maze.goal_index(pair.goal)
    distance = int(distances(maze)[n, pair.start])
    q = goal_values(maze, comparison.gamma, ACTION_SETS[comparison.actions])
    r_leg = legible_rewards(q, comparison.beta, comparison.measured_by.variant)
    warm_up(comparison)
    rows: list[dict[str, object]] = []
    for framework in frameworks:
        if comparison.preset == "authors":
            played, measures = play_and_measure(framework, maze, pair, comparison, q, r_leg)
        else:
            rng = generator(comparison.seed, world.name, pair.number, framework)
            played = play(framework, maze, pair, comparison, rng)
            measures = measure(played.rollout, n, maze, comparison, q, r_leg)
        values = (
            *(world.name, maze.states, len(maze.goals)),
            *(pair.number, pair.start, pair.goal, distance, framework),
            *(played.goal_solves_s, played.planning_s),
            *measures,
            *(played.rollout.steps, int(played.rollout.arrived), int(played.timed_out)),
        )
        rows.append(dict(zip(COLUMNS, values, strict=True)))
    return rows
