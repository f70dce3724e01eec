import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from policies import (
    ACTION_SETS,
    FAILURE,
    ModelError,
    action_beliefs,
    belief_distance,
    draw_rollout,
    goal_values,
    maze_transitions,
    movement_beliefs,
    parse_maze,
    random_maze,
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


class TestActionsSeen:
    @settings(max_examples=30, deadline=None)
    @given(st.integers(0, 10**6), st.sampled_from(["udlr", "udlrn"]))
    def test_is_bayes_rule_with_the_whole_transition_function(self, seed, name):
        rng = np.random.default_rng(seed)
        maze, actions = random_maze(4, 4, 3, rng), ACTION_SETS[name]
        q = goal_values(maze, 0.9, actions)
        policy = np.full((16, len(actions)), 1 / len(actions))
        way = draw_rollout(maze, policy, 0, 15, rng, actions, 20)
        P = maze_transitions(maze, actions).toarray().reshape(len(actions), 16, 16)
        joint = np.array([0.2, 0.5, 0.3])
        for x, a, y in zip(way.states, way.actions, way.states[1:], strict=False):
            pi = np.exp(2 * q[:, x]) / np.exp(2 * q[:, x]).sum(axis=1, keepdims=True)
            joint = joint * P[a, x, y] * pi[:, a]
        seen = action_beliefs(
            maze, q, way.states, way.actions, actions, 2.0, np.array([2.0, 5.0, 3.0])
        )
        assert seen[0] == pytest.approx([0.2, 0.5, 0.3])
        assert seen[-1] == pytest.approx(joint / joint.sum(), abs=1e-12)

    def test_a_failed_action_tells_as_much_as_one_that_moves(self):
        moved = action_beliefs(ROW, Q, np.array([1, 2]), np.array([3]), ACTIONS)
        failed = action_beliefs(ROW, Q, np.array([1, 1]), np.array([3]), ACTIONS)
        assert failed[1].tolist() == moved[1].tolist()
        assert moved[1, 1] > 0.9

    def test_over_all_actions_that_explain_it_gives_the_movement_observer(self):
        pi = np.exp(5 * Q[:, 0]) / np.exp(5 * Q[:, 0]).sum(axis=1, keepdims=True)
        stays = np.array([1, 1, 1, FAILURE, 1])
        evidence = np.zeros(2)
        for a in range(5):
            seen = action_beliefs(ROW, Q, np.array([0, 0]), np.array([a]), ACTIONS)[1]
            evidence += seen * pi[:, a].mean() * stays[a]
        movement = movement_beliefs(ROW, Q, np.array([0, 0]), ACTIONS)[1]
        assert evidence / evidence.sum() == pytest.approx(movement)

    def test_keeps_its_belief_where_no_goal_explains_the_action(self):
        both = np.stack([Q[0], Q[0]])
        prior = np.array([0.7, 0.3])
        seen = action_beliefs(ROW, both, np.array([1, 2]), np.array([3]), ACTIONS, 1e4, prior)
        assert seen[1].tolist() == pytest.approx([0.7, 0.3])

    @pytest.mark.parametrize(
        ("states", "taken", "said"),
        [
            ([0, 1], [3, 3], "one action fewer than states, came 2 for 2 states"),
            ([0, 1], [5], "actions from 0 to 4, came 5"),
            ([0, 1], [-1], "actions from 0 to 4, came -1"),
            ([0, 1], [2], "LEFT from 0 to stay or move, came to 1"),
            ([0, 2], [3], "RIGHT from 0 to stay or move, came to 2"),
        ],
    )
    def test_what_cannot_have_happened_is_refused(self, states, taken, said):
        with pytest.raises(ModelError, match=said):
            action_beliefs(ROW, Q, np.array(states), np.array(taken), ACTIONS)


class TestDistances:
    @settings(max_examples=50)
    @given(st.integers(0, 10**6), st.integers(2, 6))
    def test_are_those_of_two_distributions(self, seed, N):
        rng = np.random.default_rng(seed)
        beliefs, goal = rng.dirichlet(np.ones(N), 7), int(rng.integers(N))
        certain = np.eye(N)[goal]
        tv = np.abs(beliefs - certain).sum(axis=1) / 2
        assert belief_distance(beliefs, goal) == pytest.approx(tv)
        euclid = np.sqrt(((beliefs - certain) ** 2).sum(axis=1))
        assert belief_distance(beliefs, goal, "euclid") == pytest.approx(euclid)
        kl = np.log(1 / beliefs[:, goal])
        assert belief_distance(beliefs, goal, "kl") == pytest.approx(kl)

    @pytest.mark.parametrize("distance", ["tv", "euclid", "kl"])
    def test_certainty_is_no_distance_away(self, distance):
        assert belief_distance(np.array([[0.0, 1.0]]), 1, distance).tolist() == [0]

    def test_at_a_belief_of_zero_kl_is_infinite_and_the_others_are_at_their_largest(self):
        wrong = np.array([[1.0, 0.0]])
        assert belief_distance(wrong, 1, "kl").tolist() == [np.inf]
        assert belief_distance(wrong, 1, "tv").tolist() == [1]
        assert belief_distance(wrong, 1, "euclid") == pytest.approx([np.sqrt(2)])

    @pytest.mark.parametrize(
        ("goal", "distance", "said"),
        [
            (0, "far", "a distance in tv, euclid, kl; came 'far'"),
            (2, "tv", "a goal's index from 0 to 1, came 2"),
        ],
    )
    def test_another_distance_or_goal_is_refused(self, goal, distance, said):
        with pytest.raises(ModelError, match=said):
            belief_distance(np.array([[0.5, 0.5]]), goal, distance)
