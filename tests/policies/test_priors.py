from math import exp
from typing import get_args

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from policies import (
    ACTION_SETS,
    MDP,
    ModelError,
    Parameters,
    goal_prior,
    goal_values,
    legible_rewards,
    maze_rewards,
    maze_transitions,
    parse_maze,
    plan_legible,
    random_maze,
    solve,
)
from policies.maze_solver import Variant
from policies.priors import parse_weights

ACTIONS = ACTION_SETS["udlrn"]
VARIANTS: tuple[Variant, ...] = get_args(Variant)
ROW = parse_maze("+---+---+---+\n| A   .   B |\n+---+---+---+\n")

weights = st.lists(st.floats(-12, 0).map(lambda exponent: 10**exponent), min_size=3, max_size=3)


class TestWeights:
    def test_are_read_with_blanks_around_them(self):
        assert parse_weights("A=.5, B = 3e-1,C=2") == {"A": 0.5, "B": 0.3, "C": 2.0}

    @pytest.mark.parametrize(
        ("text", "part"),
        [
            ("", "''"),
            ("A", "'A'"),
            ("A=x", "'A=x'"),
            ("=1", "'=1'"),
            ("A=1,", "''"),
            ("A=1 B=2", "'A=1 B=2'"),
            ("A=1,A=2", "'A=2'"),
        ],
    )
    def test_the_part_that_is_none_is_named(self, text, part):
        with pytest.raises(ModelError, match=r"a prior as A=\.5,B=\.3,C=\.2") as caught:
            parse_weights(text)
        assert str(caught.value).endswith(f"came {part} in {text!r}")

    def test_are_divided_by_their_sum_in_the_order_of_the_goals(self):
        assert goal_prior(ROW, {"B": 1, "A": 3}).tolist() == [0.75, 0.25]

    @pytest.mark.parametrize(
        ("given", "came"),
        [({"A": 1}, "A"), ({"A": 1, "B": 1, "C": 1}, "A B C"), ({"A": 1, "b": 1}, "A b")],
    )
    def test_are_of_the_goals_and_of_all_of_them(self, given, came):
        with pytest.raises(ModelError, match=f"each of the goals A B, came {came}$"):
            goal_prior(ROW, given)

    @pytest.mark.parametrize("weight", [0, -1, np.nan, np.inf, 1e-320])
    def test_are_finite_and_above_0_beside_the_others(self, weight):
        for prior in ({"A": 1e10, "B": weight}, {"A": -1, "B": weight}):
            with pytest.raises(ModelError, match="weight above 0 for each of 2 goals"):
                goal_prior(ROW, prior)

    @pytest.mark.parametrize("prior", [np.ones(1), np.ones(3), np.ones((2, 1))])
    def test_are_one_for_each_goal(self, prior):
        for plan in (
            lambda: plan_legible(ROW, "A", prior=prior),
            lambda: legible_rewards(goal_values(ROW, 0.9, ACTIONS), 0.5, prior=prior),
        ):
            with pytest.raises(ModelError, match="for each of 2 goals"):
                plan()


class TestRewards:
    @pytest.mark.parametrize("variant", VARIANTS)
    def test_of_a_row_are_those_worked_out_by_hand(self, variant):
        """Three cells, A . B, gamma .5, beta 1, and in the middle the move to A.

        kappa = .85 x .5 / (1 - .15 x .5) = 17/37; V(goal) = 2, V(middle) = 2 kappa, V(end) =
        2 kappa^2. Q(left) is V(middle) for A, and .5 (.15 V(middle) + .85 V(end)) for B; up, down
        and no-op stay: .5 V(middle) for both.
        """
        prior = np.array([0.8, 0.2])
        kappa = 17 / 37
        near, far, stay = 2 * kappa, 0.15 * kappa + 0.85 * kappa**2, kappa
        total = exp(near) + exp(far) + 3 * exp(stay)
        weigh = {
            "as_printed": exp,
            "proper_posterior": lambda q: exp(q) / total,
            "advantage": lambda q: exp(q - near),
        }[variant]
        wanted = 0.8 * weigh(near) / (0.8 * weigh(near) + 0.2 * weigh(far))
        r_leg = maze_rewards(ROW, 0.5, ACTIONS, 1.0, variant, prior)[1]
        assert r_leg[:, 1, 2] == pytest.approx([wanted, 1 - wanted], abs=1e-12)
        # Standing still tells nothing: what was believed is believed.
        assert r_leg[:, 1, 4] == pytest.approx(prior, abs=1e-12)

    @settings(max_examples=60, deadline=None)
    @given(
        st.integers(0, 10**6),
        st.sampled_from(["udlr", "udlrn"]),
        st.sampled_from([(0.5, 0.9), (60.0, 0.9), (1e5, 0.99)]),
        st.sampled_from(VARIANTS),
        weights,
    )
    def test_are_those_of_the_q_values(self, seed, names, how, variant, weights):
        maze = random_maze(6, 7, 3, np.random.default_rng(seed))
        prior, (beta, gamma) = np.array(weights), how
        q, r_leg = maze_rewards(maze, gamma, ACTION_SETS[names], beta, variant, prior)
        # beta Q is known to a relative 1e-16: the exponent's rounding is all that may differ.
        rel = 1e-12 + 1e-14 * beta / (1 - gamma)
        assert r_leg == pytest.approx(legible_rewards(q, beta, variant, prior), rel=rel, abs=1e-300)

    @pytest.mark.parametrize("variant", VARIANTS)
    def test_keep_their_digits_where_belief_and_reward_pull_apart(self, variant):
        """Either side of where weights would no longer fit a number, with a belief of 1e-50."""
        prior = np.array([1.0, 1e-50])
        for beta in (55, 59, 65):
            q, r_leg = maze_rewards(ROW, 0.9, ACTIONS, beta, variant, prior)
            wanted = legible_rewards(q, beta, variant, prior)
            assert r_leg == pytest.approx(wanted, rel=1e-10, abs=1e-300)

    def test_a_uniform_prior_is_none(self):
        for variant in VARIANTS:
            given = maze_rewards(ROW, 0.9, ACTIONS, 0.5, variant, np.full(2, 7.0))[1]
            none = maze_rewards(ROW, 0.9, ACTIONS, 0.5, variant)[1]
            assert given == pytest.approx(none, rel=1e-14)


class TestPlans:
    @pytest.mark.parametrize("variant", VARIANTS)
    @pytest.mark.parametrize("formulation", ["reward", "cost"])
    def test_are_optimal_for_the_rewards_of_the_prior(self, draw_maze, formulation, variant):
        maze, prior = draw_maze(5, 6, 3, seed=3), np.array([0.1, 0.7, 0.2])
        plan = plan_legible(maze, "C", Parameters(0.5, 0.9, formulation, variant), prior)
        r_leg = legible_rewards(goal_values(maze, 0.9, ACTIONS), 0.5, variant, prior)
        assert plan.prior == pytest.approx(prior)
        assert plan.r_leg == pytest.approx(r_leg, rel=1e-12)
        P, goal = maze_transitions(maze, ACTIONS), maze.goals["C"]
        if formulation == "reward":
            wanted = solve(MDP(P, r_leg[2], 0.9)).v
            assert plan.v_legible == pytest.approx(wanted, abs=1e-9)
        else:
            q = (1 - r_leg[2]) + (P @ plan.v_legible).reshape(5, 30).T
            away = np.arange(30) != goal
            assert plan.v_legible[goal] == 0
            assert q.min(axis=1)[away] == pytest.approx(plan.v_legible[away], abs=1e-9)
