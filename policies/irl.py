"""Inverse reinforcement learning: which goal does somebody go for who acts like this?

Both predictors take the actions a seen in states x for draws from softmax over a of eta Q*_r(x, a)
under a state reward r (paper, 2.2). `bayes` weighs the maze's candidate goals by it exactly;
`gradient` climbs to the mixture r* of their rewards that explains the actions best, and names the
candidate whose reward is nearest to r*.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_softmax

from policies.errors import ModelError
from policies.maze import ACTION_SETS, Maze
from policies.mdp import Array
from policies.solvers import TIE, goal_values

Predictor = Literal["bayes", "gradient"]
Indices = NDArray[np.int64]

ACTIONS = ACTION_SETS["udlrn"]


@dataclass(frozen=True, eq=False)
class Learner:
    """Somebody who knows the maze and its goals and guesses from examples which goal is meant.

    eta: confidence in the teacher, on unscaled Q. gamma: discount in [0, 1). Examples are actions
    `a` (indices of `Action`) in states `x`, both of shape (K,), in the order they are seen.
    """

    maze: Maze
    predictor: Predictor = "bayes"
    eta: float = 10.0
    gamma: float = 0.9

    def __post_init__(self) -> None:
        if self.predictor not in get_args(Predictor):
            raise ModelError(
                f"expected predictor in {', '.join(get_args(Predictor))}; came {self.predictor!r}"
            )
        if not (np.isfinite(self.eta) and self.eta > 0):
            raise ModelError(f"expected a finite eta above 0, came {self.eta}")
        if not 0 <= self.gamma < 1:
            raise ModelError(f"expected gamma in [0, 1), came {self.gamma}")

    def guesses(self, x: Indices, a: Indices, rng: np.random.Generator) -> Indices:
        """The goal n guessed after each of the examples, shape (K,); ties are drawn by lot."""
        scores = self.scores(x, a)
        best = scores.max(axis=1, keepdims=True)
        tied = scores >= best - TIE * np.maximum(1, np.abs(best))
        lots = rng.random(scores.shape)
        guessed: Indices = np.where(tied, lots, -1).argmax(axis=1)
        return guessed

    def scores(self, x: Indices, a: Indices) -> Array:
        """How well goal n fits the first k + 1 examples, shape (K, N): `guesses` takes the best.

        `bayes`: log P(a_0..a_k | x_0..x_k, r_n), the log posterior but for a constant;
        `gradient`: cosine of the learned reward and r_n, 0 where nothing is rewarded.
        """
        self._check(x, a)
        if self.predictor == "bayes":
            seen: Array = self._log_policies[:, x, a].cumsum(axis=1).T
            return seen
        learned = [self.learn(x[:k], a[:k]).r for k in range(1, len(x) + 1)]
        return np.array([self._cosines(r) for r in learned])

    def learn(self, x: Indices, a: Indices) -> "LearnedReward":
        """Gradient ascent on the log likelihood over r = sum_n w_n r_n, each w_n in [0, 1].

        It begins at the mean of the candidates' rewards. Not every state's reward is free: then
        each action would be explained best by a reward next door, whatever the goal (Ng & Russell,
        2000), and most of what the examples tell would be lost.
        """
        from policies.irl_kernels import ascend

        self._check(x, a)
        goals = np.array(list(self.maze.goals.values()))
        return LearnedReward(*ascend(goals, x, a, self.maze.successors, self.gamma, self.eta))

    def log_likelihood(self, r: Array, x: Indices, a: Indices) -> tuple[float, Array]:
        """sum_t log P(a_t | x_t, r) and its gradient in r, shape (S,).

        The gradient of Q*_r goes through the policy that is greedy for r (paper, 2.2): where
        that is the only one, Q*_r is differentiable and this its derivative.
        """
        from policies.irl_kernels import gradient, log_likelihood

        self._check(x, a)
        given = (r, x, a, self.maze.successors, self.gamma, self.eta)
        v = np.zeros(self.maze.states)
        return log_likelihood(*given, v), gradient(*given, v, np.zeros(self.maze.states))

    @cached_property
    def _log_policies(self) -> Array:
        """log P(a | x, r_n), shape (N, S, A)."""
        q = goal_values(self.maze, self.gamma, ACTIONS)
        log_policies: Array = log_softmax(self.eta * q, axis=2)
        return log_policies

    def _cosines(self, r: Array) -> Array:
        """Cosine of a reward and each candidate's, which is 1 at the goal and 0 elsewhere."""
        length = np.linalg.norm(r)
        cosines: Array = r[list(self.maze.goals.values())] / (length if length else 1)
        return cosines

    def _check(self, x: Indices, a: Indices) -> None:
        if x.shape != a.shape or x.ndim != 1 or not len(x):
            raise ModelError(
                f"expected as many actions as states, at least 1; came {x.shape} and {a.shape}"
            )
        for name, given, end in (("states", x, self.maze.states), ("actions", a, len(ACTIONS))):
            if given.min() < 0 or given.max() >= end:
                raise ModelError(f"expected {name} from 0 to {end - 1}, came {given.tolist()}")


@dataclass(frozen=True, eq=False)
class LearnedReward:
    """The state reward `r[x]` at which the ascent ended, and sum_t log P(a_t | x_t, r) there."""

    r: Array
    log_likelihood: float
