"""A Bayesian observer who watches a robot and believes in goals."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.special import softmax

from policies.errors import ModelError
from policies.maze import FAILURE, Action, Maze
from policies.mdp import Array

OBSERVER_BETA = 5.0


def movement_beliefs(
    maze: Maze,
    q: Array,
    states: NDArray[np.int64],
    actions: Sequence[Action],
    beta: float = OBSERVER_BETA,
    prior: Array | None = None,
) -> Array:
    """Beliefs of an observer who sees only the movement, as people do: `b[t, n]`, shape (T + 1, N).

    b_t(n) is proportional to b_{t-1}(n) sum_a P(x' | x, a) pi_hat(a | x, n), with pi_hat the
    softmax of beta Q_n over actions; a movement that no goal explains leaves the belief as it was.
    `q[n, x, a]`, `states` the cells visited, shape (T + 1,).
    """
    N = len(q)
    belief = np.full(N, 1 / N) if prior is None else prior / prior.sum()
    after = maze.successors[:, list(actions)]
    beliefs = [belief]
    for x, y in pairwise(states):
        if y != x and y not in after[x]:
            raise ModelError(f"expected a step to a neighbouring cell, came {x} to {y}")
        moved = (1 - FAILURE) * (after[x] == y) + FAILURE * (x == y)
        evidence = belief * (softmax(beta * q[:, x], axis=1) @ moved)
        if evidence.sum() > 0:
            belief = evidence / evidence.sum()
        beliefs.append(belief)
    return np.array(beliefs)


def steps_until_sure(beliefs: Array, goal: int, threshold: float = 0.8) -> int:
    """Steps until the belief in the goal first exceeds the threshold; all of them if it never does.

    `beliefs[t, n]`; `goal` is the index n.
    """
    sure = beliefs[:, goal] > threshold
    return int(sure.argmax()) if sure.any() else len(beliefs) - 1
