"""Pairs of start and goal from a file, instead of drawn ones."""

import csv
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from scipy.sparse.csgraph import connected_components

from policies.errors import ModelError
from policies.experiments.worlds import Pair, World
from policies.maze import Maze

COLUMNS = ("maze", "row", "column", "goal")


def with_listed_pairs(worlds: Sequence[World], file: Path) -> list[World]:
    """The worlds that a CSV file lists pairs for, with them, in the order of the file.

    Columns as in COLUMNS: the name of a world, the start's row and column from 1 at the top left,
    a goal's letter. ModelError says file:line and what was expected.
    """
    mazes = {world.name: world.maze for world in worlds}
    listed: dict[str, list[Pair]] = {name: [] for name in mazes}
    try:
        with file.open(newline="", encoding="utf-8-sig") as text:
            rows = csv.DictReader(text)
            if tuple(rows.fieldnames or ()) != COLUMNS:
                raise ModelError(
                    f"{file}:1: expected the columns {','.join(COLUMNS)}, "
                    f"came {','.join(rows.fieldnames or ())}"
                )
            for row in rows:
                where = f"{file}:{rows.line_num}"
                if None in row or None in row.values():
                    raise ModelError(f"{where}: expected {len(COLUMNS)} cells in each line")
                name = row["maze"]
                if name not in mazes:
                    raise ModelError(
                        f"{where}: expected one of the mazes {', '.join(mazes)}; came {name!r}"
                    )
                listed[name].append(_pair(row, mazes[name], len(listed[name]), where))
    except UnicodeDecodeError as error:
        raise ModelError(f"{file}: expected text in UTF-8: {error}") from error
    if not any(listed.values()):
        raise ModelError(f"{file}:2: expected at least one pair, found none")
    return [
        replace(world, pairs=tuple(listed[world.name])) for world in worlds if listed[world.name]
    ]


def _pair(row: dict[str, str], maze: Maze, number: int, where: str) -> Pair:
    """The pair that a line tells, checked against its maze."""
    i = _place(row["row"], "row", maze.rows, where)
    j = _place(row["column"], "column", maze.cols, where)
    start, goal = (i - 1) * maze.cols + j - 1, row["goal"]
    if goal not in maze.goals:
        raise ModelError(
            f"{where}: expected a goal of the maze ({' '.join(maze.goals)}), came {goal!r}"
        )
    if start == maze.goals[goal]:
        raise ModelError(f"{where}: expected a start away from goal {goal}, came its cell {i},{j}")
    _, room = connected_components(maze.edges, directed=False)
    if room[start] != room[maze.goals[goal]]:
        raise ModelError(
            f"{where}: expected a start with a way to goal {goal}, came the enclosed cell {i},{j}"
        )
    return Pair(number, start, goal)


def _place(cell: str, name: str, last: int, where: str) -> int:
    if not cell.strip().isdecimal() or not 1 <= int(cell) <= last:
        raise ModelError(f"{where}: expected a {name} from 1 to {last}, came {cell!r}")
    return int(cell)
