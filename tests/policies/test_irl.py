import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import eye_array

from policies import (
    ACTION_SETS,
    MDP,
    Learner,
    ModelError,
    evaluate,
    goal_values,
    maze_transitions,
    parse_maze,
    plan_legible,
    random_maze,
    solve,
)
from policies.irl_kernels import greedy, occupancy, optimal_values
from policies.mdp import policy_transitions

ACTIONS = ACTION_SETS["udlrn"]
LEFT, RIGHT, NOOP = 2, 3, 4
CORRIDOR = parse_maze(f"+{'---+' * 5}\n| A   .   .   .   B |\n+{'---+' * 5}\n")


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def state_reward_mdp(maze, r, gamma) -> MDP:
    return MDP(maze_transitions(maze, ACTIONS), np.tile(r[:, None], (1, 5)), gamma)


def lesson(maze, seed, K=8):
    """Random examples: any action in any state."""
    draw = rng(seed)
    return draw.integers(maze.states, size=K), draw.integers(5, size=K)


def brute_force(maze, x, a, eta, gamma):
    """Bayes' rule over goals, one goal and one example at a time, never in log space."""
    posterior = np.ones(len(maze.goals)) / len(maze.goals)
    for n, goal in enumerate(maze.goals.values()):
        q = solve(state_reward_mdp(maze, np.eye(maze.states)[goal], gamma)).q
        for state, action in zip(x, a, strict=True):
            posterior[n] *= np.exp(eta * q[state, action]) / np.exp(eta * q[state]).sum()
    return posterior / posterior.sum()


class TestBayes:
    @pytest.mark.parametrize("eta", [0.3, 1.0, 10.0])
    @pytest.mark.parametrize("seed", range(3))
    def test_it_is_bayes_rule_by_brute_force_after_every_example(self, draw_maze, seed, eta):
        maze = draw_maze(4, 5, 3, seed=seed)
        x, a = lesson(maze, seed)
        scores = Learner(maze, eta=eta).scores(x, a)
        posterior = np.exp(scores) / np.exp(scores).sum(axis=1, keepdims=True)
        for k in range(len(x)):
            wanted = brute_force(maze, x[: k + 1], a[: k + 1], eta, 0.9)
            assert posterior[k] == pytest.approx(wanted, rel=1e-7, abs=1e-15)

    def test_on_a_corridor_one_action_decides_between_two_goals(self):
        """In the middle d = 2 both ways, so the odds of a step left are exp(eta (Q_l - Q_r))."""
        kappa, v = 0.85 * 0.9 / (1 - 0.15 * 0.9), 10
        gain = 0.9 * 0.85 * v * (kappa - kappa**3)
        for action, odds in ((LEFT, gain), (RIGHT, -gain), (NOOP, 0)):
            scores = Learner(CORRIDOR, eta=0.5).scores(np.array([2]), np.array([action]))
            assert scores[0, 0] - scores[0, 1] == pytest.approx(0.5 * odds, abs=1e-12)

    @pytest.mark.parametrize(("action", "goal"), [(LEFT, 0), (RIGHT, 1)])
    @pytest.mark.parametrize("predictor", ["bayes", "gradient"])
    def test_both_predictors_name_the_goal_of_that_action(self, predictor, action, goal):
        learner = Learner(CORRIDOR, predictor)
        for seed in range(20):
            guesses = learner.guesses(np.array([2]), np.array([action]), rng(seed))
            assert guesses.tolist() == [goal]

    @pytest.mark.parametrize("predictor", ["bayes", "gradient"])
    def test_a_tie_is_drawn_by_lot(self, predictor):
        """Standing in the middle speaks for neither end."""
        learner = Learner(CORRIDOR, predictor)
        drawn = [learner.guesses(np.array([2]), np.array([NOOP]), rng(s))[0] for s in range(200)]
        assert 60 < sum(drawn) < 140
        again = [learner.guesses(np.array([2]), np.array([NOOP]), rng(s))[0] for s in range(200)]
        assert drawn == again

    def test_ten_thousand_improbable_examples_do_not_underflow(self):
        x, a = np.full(10_000, 1), np.full(10_000, RIGHT)
        learner = Learner(CORRIDOR)
        assert np.isfinite(learner.scores(x, a)).all()
        assert (learner.guesses(x, a, rng()) == 1).all()


class TestGradient:
    @settings(max_examples=25, deadline=None)
    @given(
        st.integers(0, 10**6),
        st.sampled_from([0.0, 0.5, 0.9, 0.97]),
        st.sampled_from([0.2, 1.0, 10.0]),
    )
    def test_it_agrees_with_finite_differences(self, seed, gamma, eta):
        maze = random_maze(4, 5, 2, rng(seed))
        learner = Learner(maze, "gradient", eta, gamma)
        r = rng(seed).random(maze.states)
        x, a = lesson(maze, seed)
        _, gradient = learner.log_likelihood(r, x, a)
        h = 1e-6
        ups = [learner.log_likelihood(r + h * e, x, a)[0] for e in np.eye(maze.states)]
        downs = [learner.log_likelihood(r - h * e, x, a)[0] for e in np.eye(maze.states)]
        differences = np.subtract(ups, downs) / (2 * h)
        assert gradient == pytest.approx(differences, rel=1e-5, abs=1e-5 * eta)

    @pytest.mark.parametrize("gamma", [0.0, 0.9, 0.99])
    @pytest.mark.parametrize("seed", range(3))
    def test_the_likelihood_is_that_of_the_general_solvers_values(self, draw_maze, seed, gamma):
        maze = draw_maze(6, 6, 2, seed=seed)
        r, (x, a) = rng(seed).normal(size=36), lesson(maze, seed)
        q = solve(state_reward_mdp(maze, r, gamma)).q
        likelihood = np.exp(2 * q) / np.exp(2 * q).sum(axis=1, keepdims=True)
        value, _ = Learner(maze, eta=2, gamma=gamma).log_likelihood(r, x, a)
        assert value == pytest.approx(np.log(likelihood[x, a]).sum(), abs=1e-8)

    @pytest.mark.parametrize("gamma", [0.0, 0.5, 0.9, 0.99])
    def test_swept_systems_are_solved_as_directly(self, draw_maze, gamma):
        maze = draw_maze(7, 6, 2, seed=4)
        r, w = rng(1).normal(size=(2, 42))
        v, y = np.zeros(42), np.zeros(42)
        optimal_values(r, maze.successors, gamma, v)
        policy = greedy(r, maze.successors, gamma, v)
        mdp = state_reward_mdp(maze, r, gamma)
        assert v == pytest.approx(solve(mdp).v, rel=1e-9, abs=1e-9)
        assert v == pytest.approx(evaluate(mdp, policy), rel=1e-9, abs=1e-9)
        for mixed in (policy, rng(2).dirichlet(np.ones(5), 42)):
            occupancy(w, mixed, maze.successors, gamma, y)
            chain = eye_array(42) - gamma * policy_transitions(mdp.P, mixed)
            assert y == pytest.approx(np.linalg.solve(chain.toarray().T, w), rel=1e-8, abs=1e-8)

    def test_where_nothing_is_worth_more_the_greedy_policy_is_uniform(self, draw_maze):
        maze = draw_maze(3, 3, 2)
        assert (greedy(np.zeros(9), maze.successors, 0.9, np.zeros(9)) == 0.2).all()

    @settings(max_examples=15, deadline=None)
    @given(st.integers(0, 10**6))
    def test_what_is_learned_rewards_goals_alone_and_explains_no_worse_than_all_alike(self, seed):
        maze = random_maze(5, 5, 2, rng(seed))
        x, a = lesson(maze, seed)
        learner = Learner(maze, "gradient", 1.0)
        learned = learner.learn(x, a)
        goals = np.isin(np.arange(25), list(maze.goals.values()))
        assert (learned.r[~goals] == 0).all()
        assert (learned.r[goals] >= 0).all()
        assert (learned.r[goals] <= 1).all()
        value, _ = learner.log_likelihood(learned.r, x, a)
        assert learned.log_likelihood == pytest.approx(value, abs=1e-9)
        assert learned.log_likelihood >= learner.log_likelihood(goals / 2, x, a)[0]

    @pytest.mark.parametrize("goal", ["A", "B", "C"])
    def test_it_explains_an_optimal_teacher_no_worse_than_any_candidate_does(self, draw_maze, goal):
        """The maximum is over mixtures of the candidates, so it is not below any of them."""
        maze = draw_maze(6, 6, 3, seed=2)
        x = np.arange(36)
        a = plan_legible(maze, goal).policy_optimal.argmax(axis=1)
        learner = Learner(maze, "gradient", 1.0)
        learned = learner.learn(x, a)
        for cell in maze.goals.values():
            candidate, _ = learner.log_likelihood(np.eye(36)[cell], x, a)
            assert learned.log_likelihood >= candidate - 0.01
        assert learned.r.argmax() == maze.goals[goal]

    def test_its_scores_are_cosines(self, draw_maze):
        maze = draw_maze(5, 5, 3, seed=1)
        x, a = lesson(maze, 3)
        learner = Learner(maze, "gradient")
        r = learner.learn(x, a).r
        candidates = np.eye(25)[list(maze.goals.values())]
        assert learner.scores(x, a)[-1] == pytest.approx(candidates @ r / np.sqrt(r @ r))


class TestInput:
    @pytest.mark.parametrize(
        ("wrong", "said"),
        [
            ({"predictor": "guess"}, "predictor in bayes, gradient; came 'guess'"),
            ({"eta": 0}, "finite eta above 0, came 0"),
            ({"eta": float("nan")}, "finite eta above 0, came nan"),
            ({"gamma": 1}, r"gamma in \[0, 1\), came 1"),
        ],
    )
    def test_parameters_are_checked(self, wrong, said):
        with pytest.raises(ModelError, match=said):
            Learner(CORRIDOR, **wrong)

    @pytest.mark.parametrize(
        ("x", "a", "said"),
        [
            ([1, 2], [0], "as many actions as states, at least 1"),
            ([], [], "at least 1"),
            ([5], [0], r"states from 0 to 4, came \[5\]"),
            ([-1], [0], "states from 0 to 4"),
            ([0], [5], "actions from 0 to 4"),
        ],
    )
    @pytest.mark.parametrize("ask", ["scores", "learn"])
    def test_examples_are_checked(self, x, a, said, ask):
        with pytest.raises(ModelError, match=said):
            getattr(Learner(CORRIDOR), ask)(np.array(x, int), np.array(a, int))


def test_goal_values_are_those_of_the_goals_state_reward(draw_maze):
    """Candidates and r* live in one space: reward 1 at the goal's cell, whatever is done there."""
    maze = draw_maze(5, 5, 2, seed=3)
    q = goal_values(maze, 0.9, ACTIONS)
    for n, goal in enumerate(maze.goals.values()):
        assert q[n] == pytest.approx(solve(state_reward_mdp(maze, np.eye(25)[goal], 0.9)).q)
