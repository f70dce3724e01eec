import numpy as np
import pytest
from scipy.sparse import csr_array

from policies import ACTION_SETS, FAILURE, MDP, ModelError, maze_mdp, maze_transitions, parse_maze
from policies.mdp import policy_transitions, uniform_over

ROW = parse_maze("+---+---+---+\n| A   .   B |\n+---+---+---+\n")


class TestValidity:
    def test_shapes_must_agree(self):
        with pytest.raises(ModelError, match=r"P of shape \(4, 2\)"):
            MDP(csr_array(np.eye(2)), np.zeros((2, 2)), 0.9)

    @pytest.mark.parametrize("gamma", [-0.1, 1.0, 2.0, float("nan")])
    def test_gamma_must_be_below_one(self, gamma):
        with pytest.raises(ModelError, match="gamma"):
            MDP(csr_array(np.eye(2)), np.zeros((2, 1)), gamma)

    def test_rows_must_sum_to_one_and_the_message_says_which(self):
        P = np.array([[1, 0], [0, 1], [0.5, 0.4], [0, 1]])
        with pytest.raises(ModelError, match="x=0, a=1"):
            MDP(csr_array(P), np.zeros((2, 2)), 0.9)

    def test_probabilities_must_not_be_negative(self):
        with pytest.raises(ModelError, match="distribution"):
            MDP(csr_array(np.array([[1.5, -0.5], [0, 1]])), np.zeros((2, 1)), 0.9)

    def test_rewards_must_be_finite(self):
        with pytest.raises(ModelError, match="finite"):
            MDP(csr_array(np.eye(2)), np.full((2, 1), np.inf), 0.9)


class TestMazeAsMDP:
    def test_an_action_fails_with_its_probability_and_a_wall_always_stops(self):
        P = maze_transitions(ROW, ACTION_SETS["udlrn"]).toarray().reshape(5, 3, 3)
        up, _, left, right, noop = P
        assert np.array_equal(up, np.eye(3))
        assert np.array_equal(noop, np.eye(3))
        assert right[0].tolist() == [FAILURE, 1 - FAILURE, 0]
        assert left[0].tolist() == [1, 0, 0]

    def test_every_row_is_a_distribution(self, draw_maze):
        P = maze_transitions(draw_maze(6, 7, 2), ACTION_SETS["udlr"])
        assert P.shape == (4 * 42, 42)
        assert np.allclose(P.sum(axis=1), 1)

    def test_only_the_goal_pays(self):
        r = maze_mdp(ROW, 2, 0.9, ACTION_SETS["udlr"]).r
        assert r.tolist() == [[0] * 4, [0] * 4, [1] * 4]

    def test_one_backup_is_reward_plus_discounted_value(self):
        mdp = maze_mdp(ROW, 2, 0.5, ACTION_SETS["udlr"])
        q = mdp.q(np.array([0.0, 1.0, 2.0]))
        assert q[1, 3] == pytest.approx(0.5 * (0.15 * 1 + 0.85 * 2))
        assert q[2, 0] == pytest.approx(1 + 0.5 * 2)

    def test_a_policy_makes_a_chain(self):
        policy = np.tile([0.0, 0.0, 0.5, 0.5], (3, 1))
        chain = policy_transitions(maze_transitions(ROW, ACTION_SETS["udlr"]), policy).toarray()
        assert chain[1] == pytest.approx([0.425, 0.15, 0.425])

    def test_ties_share_alike(self):
        policy = uniform_over(np.array([[True, False, True], [False, True, False]]))
        assert policy.tolist() == [[0.5, 0, 0.5], [0, 1, 0]]
