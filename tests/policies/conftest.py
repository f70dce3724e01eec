import json
from pathlib import Path

import numpy as np
import pytest

from policies import Maze, format_maze, parse_maze, random_maze

REFERENCE = json.loads((Path(__file__).parent / "planning.json").read_text(encoding="utf-8"))


@pytest.fixture(params=sorted(REFERENCE["cases"]))
def reference(request):
    """One case of the reference numbers, with its maze parsed."""
    case = REFERENCE["cases"][request.param]
    return {**case, "parsed": parse_maze(case["maze"])}


@pytest.fixture
def draw_maze():
    """Random mazes by size, number of goals and seed."""

    def draw(rows: int, cols: int, goals: int, seed: int = 0, openness: float = 0.2) -> Maze:
        return random_maze(rows, cols, goals, np.random.default_rng(seed), openness)

    return draw


@pytest.fixture
def maze_file(tmp_path, draw_maze):
    """A 4 x 5 maze with three goals, as a file."""
    path = tmp_path / "small.txt"
    path.write_text(format_maze(draw_maze(4, 5, 3, seed=7)), encoding="utf-8")
    return path
