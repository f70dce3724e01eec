import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from policies import (
    ACTION_SETS,
    FAILURE,
    Parameters,
    certify,
    distances,
    draw_rollout,
    maze_transitions,
    parse_maze,
    plan_legible,
    random_maze,
    shortest_path_policy,
)
from policies.mdp import policy_transitions

ACTIONS = ACTION_SETS["udlrn"]
ROW = parse_maze("+---+---+---+---+\n| A   .   .   . |\n+---+---+---+---+\n")
UP, DOWN, LEFT, RIGHT, NOOP = np.eye(5)


def test_the_optimal_policy_arrives_everywhere_in_the_shortest_time(draw_maze):
    maze = draw_maze(7, 8, 3, seed=2)
    policy = shortest_path_policy(maze, maze.goals["B"], ACTIONS)
    certificate = certify(maze, policy, maze.goals["B"], ACTIONS)
    assert certificate.certified
    assert certificate.stretch == pytest.approx(np.ones(56))
    assert certificate.expected_steps == pytest.approx(distances(maze)[1] / (1 - FAILURE))


def test_a_robot_that_stands_still_does_not_arrive():
    certificate = certify(ROW, np.array([LEFT, LEFT, NOOP, LEFT]), 0, ACTIONS)
    assert certificate.arrives.tolist() == [True, True, False, False]
    assert certificate.expected_steps[:2].tolist() == pytest.approx([0, 1 / 0.85])
    assert np.isinf(certificate.expected_steps[2:]).all()
    assert np.isinf(certificate.stretch[2:]).all()
    assert not certificate.certified


def test_a_robot_that_circles_does_not_arrive():
    certificate = certify(ROW, np.array([LEFT, LEFT, RIGHT, LEFT]), 0, ACTIONS)
    assert certificate.arrives.tolist() == [True, True, False, False]


def test_a_chance_of_getting_lost_is_no_arrival():
    maze = parse_maze(
        "+---+---+---+---+\n| A   .   .   . |\n"
        "+   +   +   +   +\n| .   .   .   . |\n+---+---+---+---+\n"
    )
    policy = np.tile(LEFT, (8, 1))
    policy[[4, 5, 6, 7]] = NOOP
    policy[2] = (LEFT + DOWN) / 2
    certificate = certify(maze, policy, 0, ACTIONS)
    assert certificate.arrives.tolist() == [True, True, False, False, False, False, False, False]


def test_what_the_policy_does_at_the_goal_does_not_matter():
    certificate = certify(ROW, np.array([RIGHT, LEFT, LEFT, LEFT]), 0, ACTIONS)
    assert certificate.certified
    assert certificate.stretch.tolist() == pytest.approx([1, 1, 1, 1])


def test_an_even_walk_on_a_line_takes_its_known_time():
    policy = np.tile((LEFT + RIGHT) / 2, (4, 1))
    certificate = certify(ROW, policy, 0, ACTIONS)
    # From x on a line of n + 1 cells with a wall at n: x (2n + 1 - x) tries, each 1 / .85 steps.
    assert certificate.expected_steps == pytest.approx([x * (7 - x) / 0.85 for x in range(4)])
    assert certificate.arrives.all()


def test_a_stretch_over_4_is_arrival_without_certificate():
    policy = np.array([LEFT, 0.2 * LEFT + 0.8 * NOOP, LEFT, LEFT])
    certificate = certify(ROW, policy, 0, ACTIONS)
    assert certificate.arrives.all()
    assert certificate.stretch[1] == pytest.approx(5)
    assert certificate.holds_at.tolist() == [True, False, True, True]


def test_a_maze_of_one_cell_is_certified():
    one = parse_maze("+---+\n| A |\n+---+\n")
    certificate = certify(one, np.full((1, 5), 0.2), 0, ACTIONS)
    assert certificate.certified
    assert certificate.expected_steps.tolist() == [0]


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 10**6))
def test_simulated_steps_agree_with_the_expected(seed):
    rng = np.random.default_rng(seed)
    maze = random_maze(4, 4, 3, rng)
    plan = plan_legible(maze, "A", Parameters(guard=True))
    start = next(x for x in range(16) if x != maze.goals["A"])
    runs = [
        draw_rollout(maze, plan.policy_legible, start, maze.goals["A"], rng, ACTIONS)
        for _ in range(200)
    ]
    assert all(run.arrived for run in runs)
    steps = [run.steps for run in runs]
    error = np.std(steps) / np.sqrt(len(steps))
    expected = plan.certificate.expected_steps[start]
    assert abs(np.mean(steps) - expected) < 5 * error + 0.1


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 10**6))
def test_what_does_not_arrive_in_simulation_is_not_said_to(seed):
    rng = np.random.default_rng(seed)
    maze = random_maze(4, 4, 1, rng)
    policy = np.eye(5)[rng.integers(5, size=16)]
    certificate = certify(maze, policy, maze.goals["A"], ACTIONS)
    for start in range(16):
        run = draw_rollout(maze, policy, start, maze.goals["A"], rng, ACTIONS, max_steps=400)
        assert run.arrived == certificate.arrives[start]


@settings(max_examples=80, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([0.0, 0.3, 0.7]), st.integers(1, 4))
def test_any_policy_has_the_steps_that_dense_linear_algebra_gives(seed, openness, choices):
    rng = np.random.default_rng(seed)
    maze = random_maze(5, 6, 1, rng, openness)
    goal = maze.goals["A"]
    chosen = np.argsort(rng.random((30, 5)), axis=1) < rng.integers(1, choices + 1, (30, 1))
    towards = shortest_path_policy(maze, goal, ACTIONS)
    policy = np.where(rng.random((30, 1)) < 0.5, towards, chosen / chosen.sum(axis=1)[:, None])
    chain = policy_transitions(maze_transitions(maze, ACTIONS), policy).toarray()
    chain[goal] = np.eye(30)[goal]
    reached = np.linalg.matrix_power(chain + np.eye(30), 30) > 0
    lost = ~reached[:, goal]
    arrives = ~reached[:, lost].any(axis=1)
    certificate = certify(maze, policy, goal, ACTIONS)
    assert np.array_equal(certificate.arrives, arrives)
    assert np.isinf(certificate.expected_steps[~arrives]).all()
    way = arrives & (np.arange(30) != goal)
    leave = np.eye(way.sum()) - chain[np.ix_(way, way)]
    steps = np.linalg.solve(leave, np.ones(way.sum()))
    assert certificate.expected_steps[way] == pytest.approx(steps, rel=1e-9)


def test_a_way_through_several_cycles_takes_the_sum_of_their_times():
    cells = "   ".join(["A", *["."] * 8])
    corridor = parse_maze(f"+{'---+' * 9}\n| {cells} |\n+{'---+' * 9}\n")
    policy = np.tile(LEFT, (9, 1))
    policy[[2, 6]] = (LEFT + RIGHT) / 2
    certificate = certify(corridor, policy, 0, ACTIONS)
    # Where left and right are as likely, one step right and its way back are to be expected.
    wanted = np.array([0, 1, 4, 5, 6, 7, 10, 11, 12])
    assert certificate.expected_steps == pytest.approx(wanted / 0.85)
