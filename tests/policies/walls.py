"""Mazes with closed rooms: walls drawn one by one, rooms found by walking."""

import numpy as np

from policies import Maze


def walk(maze: Maze, start: int) -> set[int]:
    """The cells that one can walk to from a start, found by trying every wall."""
    seen, waiting = {start}, [start]
    while waiting:
        i, j = divmod(waiting.pop(), maze.cols)
        ways = (
            (j + 1 < maze.cols and not maze.wall_right[i, j], i, j + 1),
            (j > 0 and not maze.wall_right[i, j - 1], i, j - 1),
            (i + 1 < maze.rows and not maze.wall_below[i, j], i + 1, j),
            (i > 0 and not maze.wall_below[i - 1, j], i - 1, j),
        )
        for free, row, col in ways:
            if free and row * maze.cols + col not in seen:
                seen.add(row * maze.cols + col)
                waiting.append(row * maze.cols + col)
    return seen


def random_rooms(
    rows: int, cols: int, goals: int, rng: np.random.Generator
) -> tuple[Maze, np.ndarray]:
    """A maze whose goals share a room with a free cell, others closed; the room's cells (S,)."""
    while True:
        right = rng.random((rows, cols - 1)) < 0.45
        below = rng.random((rows - 1, cols)) < 0.45
        room = sorted(walk(Maze(rows, cols, {}, right, below), int(rng.integers(rows * cols))))
        if goals < len(room) < rows * cols:
            places = rng.choice(room, goals, replace=False).tolist()
            maze = Maze(rows, cols, dict(zip("ABCDEF", places, strict=False)), right, below)
            return maze, np.isin(np.arange(rows * cols), room)
