"""The maze world: a grid of cells, walls on the edges between them, lettered goals."""

import string
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, minimum_spanning_tree

from policies.errors import MazeError

FAILURE = 0.15
"""Probability that an action fails and the robot stays where it is."""


class Action(IntEnum):
    """The actions in the order of every index `a`."""

    UP = 0
    DOWN = 1
    LEFT = 2
    RIGHT = 3
    NOOP = 4


ACTION_SETS: Mapping[str, tuple[Action, ...]] = MappingProxyType(
    {"udlr": tuple(Action)[:4], "udlrn": tuple(Action)}
)


@dataclass(frozen=True, eq=False)
class Maze:
    """A maze of `rows` x `cols` cells, every one a state, numbered row-major from the top left.

    `goals` maps letters, in order, to states. `wall_right[i, j]` stands between cells (i, j) and
    (i, j + 1), `wall_below[i, j]` between (i, j) and (i + 1, j); the border is always closed.
    """

    rows: int
    cols: int
    goals: Mapping[str, int]
    wall_right: NDArray[np.bool_]
    wall_below: NDArray[np.bool_]

    def __post_init__(self) -> None:
        object.__setattr__(self, "goals", MappingProxyType(dict(self.goals)))

    def __reduce__(self) -> tuple[type["Maze"], tuple[Any, ...]]:
        # A read-only mapping does not pickle; parallel work needs mazes that do.
        return Maze, (self.rows, self.cols, dict(self.goals), self.wall_right, self.wall_below)

    @property
    def states(self) -> int:
        """Number of states S."""
        return self.rows * self.cols

    @property
    def letters(self) -> tuple[str, ...]:
        """The goals' letters in the order of every index `n`."""
        return tuple(self.goals)

    @cached_property
    def successors(self) -> NDArray[np.int64]:
        """The cell an action leads to when it does not fail: `successors[x, a]`, shape (S, 5)."""
        cells = np.arange(self.states).reshape(self.rows, self.cols)
        after = np.repeat(cells[:, :, None], len(Action), axis=2)
        after[:, :-1, Action.RIGHT] += ~self.wall_right
        after[:, 1:, Action.LEFT] -= ~self.wall_right
        after[:-1, :, Action.DOWN] += np.where(self.wall_below, 0, self.cols)
        after[1:, :, Action.UP] -= np.where(self.wall_below, 0, self.cols)
        return after.reshape(self.states, len(Action))

    @cached_property
    def rooms(self) -> NDArray[np.int32]:
        """The number of the room a cell is in, (S,): ways lead between the cells of a room."""
        rooms: NDArray[np.int32] = connected_components(self.edges, directed=False)[1]
        return rooms

    @cached_property
    def reaches_goal(self) -> NDArray[np.bool_]:
        """Whether a way leads from a cell to the goals, (S,).

        The other cells are closed rooms, and no states of any experiment: no start is drawn
        there, all values there are 0.
        """
        reaches: NDArray[np.bool_] = self.rooms == self.rooms[next(iter(self.goals.values()))]
        return reaches

    @cached_property
    def free_cells(self) -> NDArray[np.int64]:
        """The cells that hold no goal and have a way to the goals, in order."""
        free = self.reaches_goal.copy()
        free[list(self.goals.values())] = False
        return np.flatnonzero(free)

    @cached_property
    def edges(self) -> coo_array:
        """The graph of neighbouring cells without a wall between, shape (S, S), weight 1."""
        x, a = np.nonzero(self.successors != np.arange(self.states)[:, None])
        return coo_array((np.ones(len(x)), (x, self.successors[x, a])), (self.states, self.states))

    def cell(self, state: int) -> tuple[int, int]:
        """Row and column of a state, 0-based."""
        return divmod(state, self.cols)

    def goal_index(self, letter: str) -> int:
        """Index `n` of a goal's letter; MazeError when the maze has no such goal."""
        if letter not in self.goals:
            raise MazeError(
                f"expected a goal of the maze ({' '.join(self.goals)}), came {letter!r}"
            )
        return self.letters.index(letter)


def parse_maze(text: str, source: str = "maze") -> Maze:
    """Parse the text format of README's "maze files"; MazeError says source:line:column.

    Blank lines around the maze and blanks at the ends of lines (tabs too) do not matter.
    """
    lines, skipped = _trimmed(text)

    def at(line: int, column: int) -> str:
        return f"{source}:{skipped + line + 1}:{column + 1}"

    _check_shape(lines, at)
    rows, cols = len(lines) // 2, len(lines[0]) // 4
    goals: dict[str, int] = {}
    wall_right = np.zeros((rows, cols - 1), bool)
    wall_below = np.zeros((rows - 1, cols), bool)
    for line, column, expected in _slots(rows, cols):
        found = lines[line][column : column + len(expected[0])]
        if expected == _CELL:
            if found not in _CELL:
                raise _unexpected(at(line, column), "a cell: '.' or a capital letter", found)
            if found in goals:
                raise _unexpected(at(line, column), "a letter not used before", found)
            if found != ".":
                goals[found] = line // 2 * cols + column // 4
        elif found not in expected:
            wanted = " or ".join(repr(sign) for sign in expected)
            raise _unexpected(at(line, column), wanted, found)
        elif expected == _BESIDE:
            wall_right[line // 2, column // 4 - 1] = found == "|"
        elif expected == _BELOW:
            wall_below[line // 2 - 1, column // 4] = found == "---"
    if not goals:
        raise MazeError(f"{source}: expected at least one goal (a capital letter), found none")
    maze = Maze(rows, cols, dict(sorted(goals.items())), wall_right, wall_below)
    _check_goals(maze, at)
    return maze


def format_maze(maze: Maze) -> str:
    """The text of a maze; `parse_maze` reads the same maze back."""
    letter_at = {state: letter for letter, state in maze.goals.items()}
    border = "+---" * maze.cols + "+"
    lines = [border]
    for i in range(maze.rows):
        cells = [letter_at.get(i * maze.cols + j, ".") for j in range(maze.cols)]
        beside = ["|" if wall else " " for wall in maze.wall_right[i]] + ["|"]
        lines.append("|" + "".join(f" {c} {w}" for c, w in zip(cells, beside, strict=True)))
        if i < maze.rows - 1:
            below = ["---" if wall else "   " for wall in maze.wall_below[i]]
            lines.append("+" + "+".join(below) + "+")
    return "\n".join([*lines, border]) + "\n"


def random_maze(
    rows: int, cols: int, goals: int, rng: np.random.Generator, openness: float = 0.2
) -> Maze:
    """A connected maze: a random spanning tree, then a share `openness` of the other walls removed.

    `goals` cells get the letters A, B, ...; MazeError when the size or the counts are impossible.
    """
    if rows < 1 or cols < 1 or not 1 <= goals <= min(26, rows * cols):
        raise MazeError(
            f"expected at least 1 x 1 cells and 1 to {min(26, rows * cols)} goals, "
            f"came {rows} x {cols} cells and {goals} goals"
        )
    if not 0 <= openness <= 1:
        raise MazeError(f"expected openness from 0 to 1, came {openness}")
    cells = np.arange(rows * cols).reshape(rows, cols)
    pairs = np.concatenate(
        [
            np.stack([cells[:, :-1].ravel(), cells[:, 1:].ravel()], axis=1),
            np.stack([cells[:-1].ravel(), cells[1:].ravel()], axis=1),
        ]
    )
    wall = np.ones(len(pairs), bool)
    wall[_spanning_tree(pairs, rows * cols, rng)] = False
    standing = np.flatnonzero(wall)
    wall[rng.choice(standing, round(openness * len(standing)), replace=False)] = False
    letters = string.ascii_uppercase[:goals]
    places = rng.choice(rows * cols, goals, replace=False)
    beside = rows * (cols - 1)
    return Maze(
        rows,
        cols,
        dict(zip(letters, places.tolist(), strict=True)),
        wall[:beside].reshape(rows, cols - 1),
        wall[beside:].reshape(rows - 1, cols),
    )


_CELL = tuple("." + string.ascii_uppercase)
_CORNER, _BLANK, _POST, _LID = ("+",), (" ",), ("|",), ("---",)
_BESIDE, _BELOW = ("|", " "), ("---", "   ")

_Place = Callable[[int, int], str]
"""From line and column of a maze's text, 0-based, to source:line:column."""


def _slots(rows: int, cols: int) -> Iterator[tuple[int, int, tuple[str, ...]]]:
    """Every place of the text, in reading order: line, column (0-based), what may stand there."""
    for line in range(2 * rows + 1):
        wall_line = line % 2 == 0
        for j in range(cols):
            if wall_line:
                yield line, 4 * j, _CORNER
                yield line, 4 * j + 1, _LID if line in (0, 2 * rows) else _BELOW
            else:
                yield line, 4 * j, _POST if j == 0 else _BESIDE
                yield line, 4 * j + 1, _BLANK
                yield line, 4 * j + 2, _CELL
                yield line, 4 * j + 3, _BLANK
        yield line, 4 * cols, _CORNER if wall_line else _POST


def _trimmed(text: str) -> tuple[list[str], int]:
    """The lines of a maze without blanks around them, and how many blank lines stand before it."""
    lines = text.splitlines()
    filled = [number for number, line in enumerate(lines) if line.strip()] or [0, -1]
    kept = lines[filled[0] : filled[-1] + 1]
    width = len(kept[0].rstrip()) if kept else 0
    return [line[:width] + line[width:].rstrip() for line in kept], filled[0]


def _check_shape(lines: list[str], at: _Place) -> None:
    if len(lines) < 3 or len(lines) % 2 == 0:
        raise MazeError(
            f"{at(len(lines), 0)}: expected an odd number of lines, 3 or more, "
            f"ending with the border, found {len(lines)} lines"
        )
    width = len(lines[0])
    if width < 5 or width % 4 != 1:
        raise MazeError(
            f"{at(0, width)}: expected a border of '+---' repeated and a last '+', "
            f"found {width} characters"
        )
    for number, line in enumerate(lines):
        if len(line) != width:
            raise MazeError(
                f"{at(number, min(len(line), width))}: expected {width} characters as in the "
                f"first line, found {len(line)}"
            )


def _check_goals(maze: Maze, at: _Place) -> None:
    """Refuse a goal that no start could reach, and goals that no start could reach all of."""
    cells = np.bincount(maze.rooms)
    first = maze.letters[0]
    for letter, goal in maze.goals.items():
        i, j = maze.cell(goal)
        where = at(2 * i + 1, 4 * j + 2)
        if cells[maze.rooms[goal]] == 1 < maze.states:
            raise MazeError(f"{where}: expected a way to goal {letter}, found walls all around it")
        if not maze.reaches_goal[goal]:
            raise MazeError(f"{where}: expected a way from goal {letter} to {first}, found none")


def _unexpected(where: str, expected: str, found: str) -> MazeError:
    return MazeError(f"{where}: expected {expected}, found {found!r}")


def _spanning_tree(
    pairs: NDArray[np.int64], states: int, rng: np.random.Generator
) -> NDArray[np.int64]:
    """Indices of the pairs of cells that a random spanning tree joins."""
    order = rng.permutation(len(pairs))
    weights = coo_array((order + 1.0, (pairs[:, 0], pairs[:, 1])), (states, states))
    tree = minimum_spanning_tree(weights.tocsr())
    return np.argsort(order)[tree.data.astype(np.int64) - 1]
