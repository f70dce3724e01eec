"""Where a way through a maze first left a choice."""

from collections.abc import Sequence
from itertools import pairwise

from policies.maze import Maze


def first_decision(maze: Maze, cells: Sequence[int]) -> int:
    """Steps until the robot first went one way where it had another; all T if it never had one.

    `cells` are the T + 1 cells at steps 0 to T; failed actions count as steps. Until then nothing
    tells one goal from another: back to where it came from is no other way, but turning back
    where it could have gone on is a choice, and so is going on through a goal's cell.
    """
    came_from = None
    for step, (x, y) in enumerate(pairwise(cells), start=1):
        if x == y:
            continue
        others = set(maze.successors[x].tolist()) - {x, y, came_from}
        if others or x in maze.goals.values():
            return step
        came_from = x
    return len(cells) - 1
