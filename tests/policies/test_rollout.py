import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from policies import (
    ACTION_SETS,
    ModelError,
    draw_rollout,
    parse_maze,
    random_maze,
    shortest_path_policy,
)

ACTIONS = ACTION_SETS["udlrn"]
ROW = parse_maze("+---+---+---+---+\n| A   .   .   . |\n+---+---+---+---+\n")
TO_A = shortest_path_policy(ROW, 0, ACTIONS)


def draw(seed: int, policy=TO_A, start: int = 3, **options):
    return draw_rollout(ROW, policy, start, 0, np.random.default_rng(seed), ACTIONS, **options)


@given(st.integers(0, 2**32))
def test_the_same_seed_gives_the_same_rollout(seed):
    one, other = draw(seed), draw(seed)
    assert one.states.tolist() == other.states.tolist()
    assert one.actions.tolist() == other.actions.tolist()


@given(st.integers(0, 10**6))
def test_every_step_is_the_actions_or_none(seed):
    rng = np.random.default_rng(seed)
    maze = random_maze(4, 4, 1, rng)
    run = draw_rollout(maze, np.full((16, 5), 0.2), 0, maze.goals["A"], rng, ACTIONS, 50)
    assert len(run.states) == run.steps + 1
    for x, a, y in zip(run.states[:-1], run.actions, run.states[1:], strict=True):
        assert y in (x, maze.successors[x, a])


def test_stops_on_entering_the_goal():
    run = draw(1)
    assert run.arrived
    assert run.states[-1] == 0
    assert 0 not in run.states[:-1]


def test_starting_at_the_goal_takes_no_step():
    run = draw(1, start=0)
    assert (run.steps, run.arrived, run.states.tolist()) == (0, True, [0])


def test_without_a_goal_it_takes_all_steps():
    run = draw_rollout(ROW, TO_A, 3, None, np.random.default_rng(1), ACTIONS, max_steps=40)
    assert (run.steps, run.arrived, run.states[-1]) == (40, False, 0)


def test_gives_up_after_the_steps_allowed():
    run = draw(1, policy=np.tile(np.eye(5)[4], (4, 1)), max_steps=7)
    assert (run.steps, run.arrived) == (7, False)


def test_actions_fail_as_often_as_they_should():
    moves = [draw(seed) for seed in range(600)]
    steps = sum(run.steps for run in moves)
    failed = sum(int((np.diff(run.states) == 0).sum()) for run in moves)
    assert failed / steps == pytest.approx(0.15, abs=5 * np.sqrt(0.15 * 0.85 / steps))


def test_actions_come_as_often_as_the_policy_says():
    policy = np.tile([0.0, 0.1, 0.2, 0.0, 0.7], (4, 1))
    taken = np.concatenate([draw(seed, policy).actions for seed in range(150)])
    counts = np.bincount(taken, minlength=5) / len(taken)
    assert counts[[0, 3]].tolist() == [0, 0]
    assert counts == pytest.approx(policy[0], abs=5 * np.sqrt(0.25 / len(taken)))


def test_an_action_without_probability_is_never_taken():
    class Lowest(np.random.Generator):
        def random(self, *_, **__):
            return 0.0

    policy = np.tile([0.0, 0.0, 0.0, 0.0, 1.0], (4, 1))
    run = draw_rollout(ROW, policy, 3, 0, Lowest(np.random.PCG64()), ACTIONS, max_steps=3)
    assert run.actions.tolist() == [4, 4, 4]


@pytest.mark.parametrize("start", [-1, 4])
def test_a_start_outside_the_maze_is_refused(start):
    with pytest.raises(ModelError, match=f"a start from 0 to 3, came {start}"):
        draw(1, start=start)
