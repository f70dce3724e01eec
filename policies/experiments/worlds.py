"""The worlds of the framework comparison, and the pairs of start and goal in each."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from policies.maze import Maze, random_maze
from policies.maze_files import read_mazes
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
    """The mazes of a folder's .txt files, smallest first, each a world named by its file.

    MazeError names every file that is no maze or has no cell to start from beside the goal's.
    """
    worlds = [World(name, maze) for name, maze in read_mazes(folder, _unfit).items()]
    return sorted(worlds, key=lambda world: (world.maze.states, len(world.maze.goals)))


def draw_pairs(world: World, count: int, seed: int) -> Sequence[Pair]:
    """Starts and goals at random with replacement, the start never its goal's cell.

    No start is in a closed room.
    """
    rng = generator(seed, world.name, "pairs")
    cells = np.flatnonzero(world.maze.reaches_goal)
    pairs = []
    for number in range(count):
        letter = world.maze.letters[rng.integers(len(world.maze.goals))]
        i = rng.integers(len(cells) - 1)
        i += cells[i] >= world.maze.goals[letter]
        pairs.append(Pair(number, int(cells[i]), letter))
    return pairs


def _unfit(maze: Maze) -> str | None:
    if maze.states == 1:
        return "expected a cell to start from beside the goal's"
    return None
