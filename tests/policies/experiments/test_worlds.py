import hashlib
from collections import Counter

import numpy as np
import pytest

from policies import MazeError, format_maze, random_maze
from policies.experiments.worlds import World, draw_pairs, drawn_worlds, read_worlds


def test_the_goals_test_has_one_size_and_three_to_ten_goals():
    worlds = drawn_worlds("goals", seed=1)
    assert [len(world.maze.goals) for world in worlds] == [3, 4, 5, 6, 7, 8, 9, 10]
    assert {(world.maze.rows, world.maze.cols) for world in worlds} == {(25, 25)}
    assert worlds[0].name == "3 goals"


def test_the_states_test_has_the_papers_sizes():
    worlds = drawn_worlds("states", seed=1)
    assert [world.name for world in worlds] == [
        *("5x8", "10x10", "25x25", "40x40", "50x50", "60x60", "75x75")
    ]
    assert [f"{world.maze.rows}x{world.maze.cols}" for world in worlds] == [w.name for w in worlds]
    assert [len(world.maze.goals) for world in worlds] == [3, 6, 6, 6, 6, 6, 6]


def test_worlds_come_from_the_seed():
    one, same, other = (
        [format_maze(world.maze) for world in drawn_worlds("goals", seed)] for seed in (1, 1, 2)
    )
    assert one == same
    assert all(a != b for a, b in zip(one, other, strict=True))


def test_a_folder_of_mazes_is_read_smallest_first(tmp_path):
    for name, rows, goals in (("a", 4, 2), ("b", 2, 3), ("c", 2, 2)):
        maze = random_maze(rows, 3, goals, np.random.default_rng(0))
        (tmp_path / f"{name}.txt").write_text(format_maze(maze), encoding="utf-8")
    assert [world.name for world in read_worlds(tmp_path)] == ["c", "b", "a"]


def test_a_maze_needs_a_cell_to_start_from(tmp_path):
    for name in ("cell", "room"):
        (tmp_path / f"{name}.txt").write_text("+---+\n| A |\n+---+\n", encoding="utf-8")
    said = r"cell\.txt: expected a cell to start from .*\n.*room\.txt: expected a cell to start"
    with pytest.raises(MazeError, match=said):
        read_worlds(tmp_path)


class TestPairs:
    def test_every_start_is_as_likely_and_none_is_the_goal(self):
        world = World("w", random_maze(2, 3, 2, np.random.default_rng(4)))
        pairs = draw_pairs(world, 6000, seed=1)
        assert [pair.number for pair in pairs] == list(range(6000))
        counts = Counter((pair.goal, pair.start) for pair in pairs)
        assert all(start != world.maze.goals[goal] for goal, start in counts)
        assert len(counts) == 10
        # Each is expected 600 times, with a standard deviation of 23.
        assert all(500 < count < 700 for count in counts.values())

    @pytest.mark.parametrize(
        ("test", "digest"),
        [
            ("goals", "d27f93223be3940349d023a7ff99e0a7183903afa4505e05a1c05117117ce2d2"),
            ("states", "b6e9594d11c2acd80dec4dd9ef8330bbb2e013f7e78f2ef96e202d2f10045a91"),
        ],
    )
    def test_are_those_that_were_drawn_before_closed_rooms_were_allowed(self, test, digest):
        """SHA-256 of the default run's 250 pairs a world, as the code of that time drew them."""
        lines = [
            f"{world.name} {pair.number} {pair.start} {pair.goal}\n"
            for world in drawn_worlds(test, 2209)
            for pair in draw_pairs(world, 250, 2209)
        ]
        assert hashlib.sha256("".join(lines).encode()).hexdigest() == digest

    def test_a_longer_list_begins_with_a_shorter_one(self):
        world = World("w", random_maze(5, 5, 3, np.random.default_rng(4)))
        assert draw_pairs(world, 20, seed=1)[:5] == draw_pairs(world, 5, seed=1)
        assert draw_pairs(world, 20, seed=2) != draw_pairs(world, 20, seed=1)
