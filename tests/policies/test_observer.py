import numpy as np
import pytest

from policies import (
    ACTION_SETS,
    ModelError,
    goal_values,
    movement_beliefs,
    parse_maze,
    steps_until_sure,
)

ACTIONS = ACTION_SETS["udlrn"]
ROW = parse_maze("+---+---+---+\n| A   .   B |\n+---+---+---+\n")
Q = goal_values(ROW, 0.9, ACTIONS)


def test_agrees_with_the_reference(reference):
    observer = reference["observer"]
    beliefs = movement_beliefs(
        reference["parsed"],
        np.array(reference["q"]),
        np.array(observer["path"]),
        ACTIONS,
        beta=observer["beta"],
    )
    assert beliefs == pytest.approx(np.array(observer["belief_movement_only"]), abs=1e-8)


def test_begins_with_the_prior():
    uniform = movement_beliefs(ROW, Q, np.array([1]), ACTIONS)
    assert uniform.tolist() == [[0.5, 0.5]]
    leaning = movement_beliefs(ROW, Q, np.array([1]), ACTIONS, prior=np.array([3.0, 1.0]))
    assert leaning.tolist() == [[0.75, 0.25]]


def test_one_step_is_bayes_rule_by_hand():
    beta = 0.3
    pi = np.exp(beta * Q[:, 1]) / np.exp(beta * Q[:, 1]).sum(axis=1, keepdims=True)
    right = 0.85 * pi[:, 3]
    beliefs = movement_beliefs(ROW, Q, np.array([1, 2]), ACTIONS, beta=beta)
    assert beliefs[1] == pytest.approx(right / right.sum())


def test_standing_still_is_explained_by_failure_no_op_and_walls_together():
    pi = np.exp(5 * Q[:, 0]) / np.exp(5 * Q[:, 0]).sum(axis=1, keepdims=True)
    still = pi[:, [0, 1, 2, 4]].sum(axis=1) + 0.15 * pi[:, 3]
    beliefs = movement_beliefs(ROW, Q, np.array([0, 0]), ACTIONS)
    assert beliefs[1] == pytest.approx(still / still.sum())


def test_in_the_middle_standing_still_says_nothing():
    beliefs = movement_beliefs(ROW, Q, np.array([1, 1, 1]), ACTIONS)
    assert beliefs == pytest.approx(np.full((3, 2), 0.5))


def test_remembers_the_steps_before():
    twice = movement_beliefs(ROW, Q, np.array([1, 2, 2]), ACTIONS, beta=0.2)
    once = movement_beliefs(ROW, Q, np.array([2, 2]), ACTIONS, beta=0.2, prior=twice[1])
    assert twice[2] == pytest.approx(once[1])


def test_keeps_its_belief_where_no_goal_explains_the_movement():
    # With this beta the wrong move has a probability of 0 for every goal.
    one_goal_side = np.stack([Q[0], Q[0]])
    path = np.array([1, 2])
    beliefs = movement_beliefs(ROW, one_goal_side, path, ACTIONS, 1e4, np.array([0.7, 0.3]))
    assert beliefs[1].tolist() == pytest.approx([0.7, 0.3])


def test_a_jump_is_refused():
    with pytest.raises(ModelError, match="neighbouring cell, came 0 to 2"):
        movement_beliefs(ROW, Q, np.array([0, 2]), ACTIONS)


def test_a_step_through_a_wall_is_refused():
    walled = parse_maze(
        "+---+---+\n| A | B |\n+   +   +\n| .   . |\n+---+---+\n",
    )
    q = goal_values(walled, 0.9, ACTIONS)
    with pytest.raises(ModelError, match="came 0 to 1"):
        movement_beliefs(walled, q, np.array([0, 1]), ACTIONS)


def test_sure_is_the_first_step_above_the_threshold():
    beliefs = np.array([[0.5, 0.5], [0.2, 0.8], [0.1, 0.9], [0.3, 0.7], [0.0, 1.0]])
    assert steps_until_sure(beliefs, 1) == 2
    assert steps_until_sure(beliefs, 1, threshold=0.5) == 1


def test_never_sure_counts_the_whole_length():
    assert steps_until_sure(np.array([[0.5, 0.5], [0.6, 0.4], [0.7, 0.3]]), 1) == 2
