"""From a scene, as pages draw it, back to the maze."""

import numpy as np

from policies.maze import Maze
from policies.pool import Scene


def scene_maze(scene: Scene) -> Maze:
    """The maze that a scene shows: its walls again on the edges between cells."""
    across = np.zeros((scene.rows + 1, scene.cols), bool)
    down = np.zeros((scene.rows, scene.cols + 1), bool)
    for x1, y1, x2, y2 in scene.walls:
        # A segment runs one way: in the other its range is empty.
        across[y1, x1:x2] = True
        down[y1:y2, x1] = True
    goals = {area.letter: area.cell for area in scene.areas}
    return Maze(scene.rows, scene.cols, goals, wall_right=down[:, 1:-1], wall_below=across[1:-1])
