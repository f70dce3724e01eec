"""The worlds of the framework comparison, and the pairs of start and goal in each."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from policies.errors import MazeError
from policies.maze import Maze, random_maze, read_mazes
from policies.pool_rule import generator

Test = Literal["goals", "states"]

GOAL_COUNTS = range(3, 11)
GOALS_SIZE = (25, 25)
STATE_SIZES = ((5, 8), (10, 10), (25, 25), (40, 40), (50, 50), (60, 60), (75, 75))
MANY_GOALS, FEW_GOALS = 6, 3


@dataclass(frozen=True)
class Pair:
    """The `number`-th start state and goal letter of a world."""

    number: int
    start: int
    goal: str


@dataclass(frozen=True, eq=False)
class World:
    """A maze under a name that tables and figures show; `pairs` are those of a file, if any."""

    name: str
    maze: Maze
    pairs: tuple[Pair, ...] | None = None


def drawn_worlds(test: Test, seed: int) -> list[World]:
    """Fresh random mazes for a test of the paper, 4.2: 8 of `goals`, 7 of `states`."""
    if test == "goals":
        shapes = [(f"{N} goals", *GOALS_SIZE, N) for N in GOAL_COUNTS]
    else:
        # The paper's smallest maze has fewer goals: six would crowd its forty cells.
        shapes = [
            (f"{rows}x{cols}", rows, cols, FEW_GOALS if i == 0 else MANY_GOALS)
            for i, (rows, cols) in enumerate(STATE_SIZES)
        ]
    return [
        World(name, random_maze(rows, cols, N, generator(seed, test, name)))
        for name, rows, cols, N in shapes
    ]


def read_worlds(folder: Path) -> list[World]:
    """The mazes of a folder's .txt files, smallest first, each a world named by its file."""
    worlds = [World(name, maze) for name, maze in read_mazes(folder).items()]
    for world in worlds:
        if world.maze.states == 1:
            raise MazeError(
                f"{folder / world.name}.txt: expected a cell to start from beside the goal's"
            )
    return sorted(worlds, key=lambda world: (world.maze.states, len(world.maze.goals)))


def draw_pairs(world: World, count: int, seed: int) -> Sequence[Pair]:
    """Starts and goals at random with replacement, the start never its goal's cell."""
    rng = generator(seed, world.name, "pairs")
    pairs = []
    for number in range(count):
        letter = world.maze.letters[rng.integers(len(world.maze.goals))]
        start = int(rng.integers(world.maze.states - 1))
        start += start >= world.maze.goals[letter]
        pairs.append(Pair(number, start, letter))
    return pairs
