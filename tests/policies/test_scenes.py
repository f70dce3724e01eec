import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from policies import Area, Maze, Scene, format_maze, load_pool, random_maze, scene_maze
from policies.pool_build import package_mazes, scene

POOL = load_pool()
MAZES = package_mazes()


def drawn(maze: Maze) -> Scene:
    """The scene of a maze, as it comes from the pool's file."""
    fields = scene(maze)
    areas = tuple(Area(letter, cell) for letter, cell in fields["areas"].items())
    walls = tuple((x1, y1, x2, y2) for x1, y1, x2, y2 in fields["walls"])
    return Scene(fields["rows"], fields["cols"], walls, areas)


def test_every_scene_of_the_pool_has_its_maze():
    assert set(POOL.scenes) == set(MAZES)


@pytest.mark.parametrize("name", sorted(MAZES))
def test_a_scene_gives_back_the_committed_maze(name):
    assert format_maze(scene_maze(POOL.scenes[name])) == format_maze(MAZES[name])


@given(
    rows=st.integers(1, 6),
    cols=st.integers(1, 6),
    seed=st.integers(0, 10**6),
    openness=st.floats(0, 1),
)
def test_any_maze_comes_back_from_its_scene(rows, cols, seed, openness):
    maze = random_maze(rows, cols, 1, np.random.default_rng(seed), openness)
    assert format_maze(scene_maze(drawn(maze))) == format_maze(maze)
