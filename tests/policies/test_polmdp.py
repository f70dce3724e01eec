from itertools import product

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from policies import (
    ACTION_SETS,
    FAILURE,
    MDP,
    Maze,
    MazeError,
    ModelError,
    Parameters,
    certify,
    legible_rewards,
    maze_transitions,
    parse_maze,
    plan_legible,
    random_maze,
    shortest_path_policy,
    solve,
)
from policies.polmdp import guard

VARIANTS = ("as_printed", "proper_posterior", "advantage")
FORMULATIONS = ("reward", "cost")


class TestReference:
    def test_posteriors_agree(self, reference):
        q = np.array(reference["q"])
        r = legible_rewards(q, reference["beta"])
        assert r == pytest.approx(np.array(reference["r_leg"]), abs=1e-8)

    @pytest.mark.parametrize("formulation", FORMULATIONS)
    def test_legible_values_agree(self, reference, formulation):
        for n, goal in enumerate(reference["goals"]):
            plan = plan_legible(reference["parsed"], goal, Parameters(formulation=formulation))
            wanted = np.array(reference[f"v_legible_{formulation}"][n])
            assert plan.v_legible == pytest.approx(wanted, abs=1e-8)
            assert plan.q == pytest.approx(np.array(reference["q"]), abs=1e-8)

    def test_legible_actions_agree(self, reference):
        for n, goal in enumerate(reference["goals"]):
            policy = plan_legible(reference["parsed"], goal).policy_legible
            taken = [np.flatnonzero(row).tolist() for row in policy]
            assert taken == reference["greedy_legible_reward"][n]


class TestPosterior:
    @settings(max_examples=30)
    @given(
        st.integers(0, 10**6), st.sampled_from(VARIANTS), st.floats(0.01, 1000), st.integers(1, 5)
    )
    def test_sums_to_one_over_goals(self, seed, variant, beta, N):
        q = np.random.default_rng(seed).uniform(0, 100, (N, 6, 5))
        r = legible_rewards(q, beta, variant)
        assert np.isfinite(r).all()
        assert r.sum(axis=0) == pytest.approx(np.ones((6, 5)))

    def test_is_a_softmax_over_goals(self):
        q = np.array([[[1.0, 2.0]], [[3.0, 0.0]]])
        odds = np.exp(0.5 * (q[0] - q[1]))
        assert legible_rewards(q, 0.5)[0] == pytest.approx(odds / (1 + odds))

    def test_the_proper_posterior_is_bayes_over_normalised_policies(self):
        q = np.random.default_rng(1).uniform(0, 10, (3, 4, 5))
        likelihood = np.exp(0.5 * q) / np.exp(0.5 * q).sum(axis=2, keepdims=True)
        wanted = likelihood / likelihood.sum(axis=0)
        assert legible_rewards(q, 0.5, "proper_posterior") == pytest.approx(wanted)

    def test_the_advantage_takes_the_value_of_the_place_away(self):
        q = np.random.default_rng(1).uniform(0, 10, (3, 4, 5))
        shifted = q + np.array([5.0, -2.0, 0.0])[:, None, None]
        assert legible_rewards(shifted, 0.5, "advantage") == pytest.approx(
            legible_rewards(q, 0.5, "advantage")
        )
        weight = np.exp(0.5 * (q - q.max(axis=2, keepdims=True)))
        wanted = weight / weight.sum(axis=0)
        assert legible_rewards(q, 0.5, "advantage") == pytest.approx(wanted)

    def test_does_not_overflow(self):
        q = np.array([[[1e6]], [[1e6 - 1]]])
        assert legible_rewards(q, 1.0)[0] == pytest.approx(1 / (1 + np.exp(-1)))

    def test_a_prior_weighs_the_goals(self):
        q = np.zeros((2, 3, 5))
        assert legible_rewards(q, 0.5, prior=np.array([3.0, 1.0]))[0] == pytest.approx(0.75)

    @pytest.mark.parametrize("prior", [[1.0], [1.0, 0.0], [1.0, -1.0]])
    def test_a_prior_is_above_zero_for_each_goal(self, prior):
        with pytest.raises(ModelError, match="weight above 0 for each of 2 goals"):
            legible_rewards(np.zeros((2, 3, 5)), 0.5, prior=np.array(prior))


class TestParameters:
    def test_the_defaults_are_the_papers(self):
        assert Parameters() == Parameters(0.5, 0.9, "reward", "as_printed", "udlrn", False)

    @pytest.mark.parametrize(
        ("wrong", "said"),
        [
            ({"beta": 0}, "beta above 0, came 0"),
            ({"beta": float("inf")}, "finite beta"),
            ({"beta": float("nan")}, "finite beta"),
            ({"gamma": 1}, r"gamma in \[0, 1\), came 1"),
            ({"gamma": -0.1}, "gamma"),
            ({"formulation": "best"}, "formulation in reward, cost; came 'best'"),
            ({"variant": "x"}, "variant in as_printed, proper_posterior, advantage; came 'x'"),
            ({"actions": "lr"}, "actions in udlr, udlrn; came 'lr'"),
        ],
    )
    def test_others_are_refused_with_what_is_expected(self, wrong, said):
        with pytest.raises(ModelError, match=said):
            Parameters(**wrong)

    def test_an_unknown_goal_is_refused(self, draw_maze):
        with pytest.raises(MazeError, match="came 'Z'"):
            plan_legible(draw_maze(3, 3, 2), "Z")


class TestPlans:
    @pytest.mark.parametrize("variant", VARIANTS)
    @pytest.mark.parametrize("actions", ["udlr", "udlrn"])
    def test_the_reward_formulation_is_the_mdp_with_the_posterior_as_reward(
        self, draw_maze, variant, actions
    ):
        maze = draw_maze(6, 6, 3, seed=5)
        plan = plan_legible(maze, "B", Parameters(variant=variant, actions=actions))
        P = maze_transitions(maze, ACTION_SETS[actions])
        assert plan.v_legible == pytest.approx(solve(MDP(P, plan.r_leg[1], 0.9)).v, abs=1e-9)

    @pytest.mark.parametrize("variant", VARIANTS)
    def test_the_cost_formulation_solves_its_equation_and_ends_at_the_goal(
        self, draw_maze, variant
    ):
        maze = draw_maze(6, 6, 3, seed=6)
        plan = plan_legible(maze, "C", Parameters(formulation="cost", variant=variant))
        v, cost = plan.v_legible, 1 - plan.r_leg[2]
        q = cost + FAILURE * v[:, None] + (1 - FAILURE) * v[maze.successors]
        away = np.arange(36) != maze.goals["C"]
        assert v[maze.goals["C"]] == 0
        assert q.min(axis=1)[away] == pytest.approx(v[away], abs=1e-9)

    def test_in_the_cost_formulation_the_robot_at_its_goal_does_as_the_optimal_one(self):
        field = parse_maze(
            "+---+---+---+\n| .   .   . |\n+   +   +   +\n| .   A   . |\n+   +   +   +\n"
            "| .   .   B |\n+---+---+---+\n"
        )
        plan = plan_legible(field, "A", Parameters(formulation="cost", actions="udlr"))
        assert plan.policy_legible[4].tolist() == [0.25, 0.25, 0.25, 0.25]

    @settings(max_examples=12, deadline=None)
    @given(
        st.integers(0, 10**6),
        st.sampled_from(VARIANTS),
        st.sampled_from(["udlr", "udlrn"]),
        st.sampled_from([(0.5, 0.9), (5.0, 0.99), (500.0, 0.99)]),
    )
    def test_the_cost_formulation_arrives_from_everywhere(self, seed, variant, actions, how):
        maze = random_maze(6, 6, 3, np.random.default_rng(seed))
        beta, gamma = how
        plan = plan_legible(maze, "A", Parameters(beta, gamma, "cost", variant, actions))
        assert plan.certificate.arrives.all()

    @settings(max_examples=25, deadline=None)
    @given(
        st.integers(0, 10**6),
        st.sampled_from(FORMULATIONS),
        st.sampled_from(VARIANTS),
        st.sampled_from(["udlr", "udlrn"]),
        st.sampled_from([(0.5, 0.9), (0.5, 0.5), (50.0, 0.99)]),
    )
    def test_the_guard_certifies_always(self, seed, formulation, variant, actions, how):
        maze = random_maze(6, 7, 3, np.random.default_rng(seed))
        beta, gamma = how
        parameters = Parameters(beta, gamma, formulation, variant, actions, guard=True)
        plan = plan_legible(maze, "A", parameters)
        assert plan.certificate.certified

    @settings(max_examples=25, deadline=None)
    @given(st.integers(0, 10**6))
    # Policies that leave some cells with a chance which no number holds beside the others.
    @example(5)
    @example(5609)
    def test_the_guard_certifies_any_policy(self, seed):
        rng = np.random.default_rng(seed)
        maze = random_maze(5, 6, 2, rng)
        goal, actions = maze.goals["A"], ACTION_SETS["udlrn"]
        optimal = shortest_path_policy(maze, goal, actions)
        policy = rng.dirichlet(np.full(5, 0.2), 30)
        guarded, repaired = guard(maze, goal, policy, optimal, actions)
        assert repaired.any() == (not certify(maze, policy, goal, actions).certified)
        assert certify(maze, guarded, goal, actions).certified

    @pytest.mark.parametrize("seed", [5, 393, 2274])
    def test_nobody_arrives_in_less_than_no_time(self, seed):
        rng = np.random.default_rng(seed)
        maze = random_maze(5, 6, 2, rng)
        policy = rng.dirichlet(np.full(5, 0.2), 30)
        proof = certify(maze, policy, maze.goals["A"], ACTION_SETS["udlrn"])
        assert (proof.expected_steps >= 0).all()
        assert not proof.certified

    def test_the_guard_changes_only_what_it_marks(self):
        maze = random_maze(25, 25, 3, np.random.default_rng(1))
        how = Parameters(beta=0.5, gamma=0.5)
        loose = plan_legible(maze, "A", how)
        kept = plan_legible(maze, "A", Parameters(beta=0.5, gamma=0.5, guard=True))
        assert not loose.certificate.certified
        assert not loose.repaired.any()
        assert kept.repaired.any()
        assert np.array_equal(
            kept.policy_legible[~kept.repaired], loose.policy_legible[~kept.repaired]
        )
        assert np.array_equal(
            kept.policy_legible[kept.repaired], kept.policy_optimal[kept.repaired]
        )

    @pytest.mark.parametrize(
        ("formulation", "variant", "actions"),
        list(product(FORMULATIONS, VARIANTS, ["udlr", "udlrn"])),
    )
    @pytest.mark.parametrize("shape", [(1, 1), (1, 6), (6, 1), (5, 5)])
    def test_with_a_single_goal_the_robot_goes_straight_there(
        self, draw_maze, shape, formulation, variant, actions
    ):
        maze = draw_maze(*shape, 1, seed=3)
        plan = plan_legible(
            maze, "A", Parameters(formulation=formulation, variant=variant, actions=actions)
        )
        assert plan.certificate.stretch == pytest.approx(np.ones(maze.states))

    def test_where_the_posterior_saturates_ties_break_towards_the_goal(self, draw_maze):
        maze = draw_maze(20, 20, 3, seed=1)
        for goal in maze.letters:
            plan = plan_legible(maze, goal, Parameters(beta=5, gamma=0.99))
            assert (plan.r_leg[maze.goal_index(goal)] == 1).any()
            assert plan.certificate.certified

    @settings(max_examples=12, deadline=None)
    @given(st.integers(0, 10**6), st.sampled_from(FORMULATIONS), st.sampled_from(VARIANTS))
    def test_the_goals_letters_do_not_matter(self, seed, formulation, variant):
        rng = np.random.default_rng(seed)
        maze = random_maze(5, 5, 3, rng)
        letters = dict(zip("ABC", rng.permutation(list("XYZ")), strict=True))
        renamed = Maze(
            5,
            5,
            dict(sorted((letters[k], x) for k, x in maze.goals.items())),
            maze.wall_right,
            maze.wall_below,
        )
        how = Parameters(formulation=formulation, variant=variant)
        one, other = plan_legible(maze, "B", how), plan_legible(renamed, letters["B"], how)
        assert other.v_legible == pytest.approx(one.v_legible, abs=1e-9)
        assert np.array_equal(other.policy_legible, one.policy_legible)

    @pytest.mark.parametrize("formulation", FORMULATIONS)
    def test_policies_are_distributions(self, draw_maze, formulation):
        plan = plan_legible(draw_maze(6, 6, 4), "A", Parameters(formulation=formulation))
        for policy in (plan.policy_optimal, plan.policy_legible):
            assert (policy >= 0).all()
            assert policy.sum(axis=1) == pytest.approx(np.ones(36))
