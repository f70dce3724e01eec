from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from policies import (
    ACTION_SETS,
    draw_rollout,
    first_decision,
    load_pool,
    parse_maze,
    random_maze,
    scene_maze,
    shortest_path_policy,
)

ACTIONS = ACTION_SETS["udlrn"]
POOL = load_pool()

# A passage from the left with one fork, at cell 2; cells are numbered by row.
FORK = parse_maze("""\
+---+---+---+---+---+
| .   .   .   .   A |
+---+---+   +---+---+
| B   .   .   .   C |
+---+---+---+---+---+
""")
PASSAGE = parse_maze("+---+---+---+---+---+\n| .   .   A   .   B |\n+---+---+---+---+---+\n")


@pytest.mark.parametrize(
    ("cells", "steps"),
    [
        ([2, 3, 4], 1),  # three ways from the start
        ([1, 0], 1),  # two ways from the start
        ([0, 1, 2, 3, 4], 3),  # one way up to the fork, two from there
        ([0, 1, 2, 7, 8, 9], 3),
        ([0, 0, 1, 2, 2, 2, 3, 4], 6),  # actions that fail take their time, also at the fork
        ([0, 1, 0, 1, 2, 3, 4], 2),  # it turns back where it could have gone on
        ([0, 1, 2, 1], 3),  # back is one of the ways from the fork
    ],
)
def test_a_decision_is_the_first_way_taken_where_there_was_another(cells, steps):
    assert first_decision(FORK, cells) == steps


def test_going_on_through_an_area_tells_that_it_is_not_the_goal():
    assert first_decision(PASSAGE, [0, 1, 2, 3, 4]) == 3


@pytest.mark.parametrize(("cells", "steps"), [([0, 1, 2], 2), ([0, 1, 1, 2], 3), ([0], 0)])
def test_without_any_choice_it_is_the_whole_way(cells, steps):
    assert first_decision(PASSAGE, cells) == steps


@given(
    size=st.integers(2, 6), openness=st.sampled_from([0.0, 0.1, 0.4]), seed=st.integers(0, 10**6)
)
def test_until_then_there_is_one_way_to_go_and_with_it_there_are_more(size, openness, seed):
    rng = np.random.default_rng(seed)
    maze = random_maze(size, size, 1, rng, openness)
    start, goal = int(rng.integers(maze.states)), maze.goals["A"]
    assume(start != goal)
    policy = shortest_path_policy(maze, goal, ACTIONS)
    cells = draw_rollout(maze, policy, start, goal, rng, ACTIONS).states.tolist()
    steps = first_decision(maze, cells)
    moves = sum(x != y for x, y in pairwise(cells[: steps + 1]))
    assert cells[steps] != cells[steps - 1]
    assert len(ways(maze, start, moves - 1)) == 1
    assert len(ways(maze, start, moves)) > 1 or steps == len(cells) - 1


def ways(maze, start, moves):
    """Every way of so many moves from a start that does not turn back."""
    found: list[tuple[int, ...]] = [(start,)]
    for _ in range(moves):
        found = [
            (*way, y)
            for way in found
            for y in set(maze.successors[way[-1]].tolist()) - {way[-1], *way[-2:-1]}
        ]
    return found


def test_every_animation_of_the_study_decides_before_its_end():
    for shown in POOL.stimuli.values():
        assert 1 <= first_decision(scene_maze(POOL.scenes[shown.maze]), shown.cells) < shown.steps
