"""A Bayesian observer who watches a robot and believes in goals."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.special import softmax

from policies.errors import ModelError
from policies.maze import FAILURE, Action, Maze
from policies.mdp import Array

OBSERVER_BETA = 5.0

Distance = Literal["tv", "euclid", "kl"]


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
    beliefs = [_first_belief(q, prior)]
    after = maze.successors[:, list(actions)]
    for x, y in pairwise(states):
        if y != x and y not in after[x]:
            raise ModelError(f"expected a step to a neighbouring cell, came {x} to {y}")
        moved = (1 - FAILURE) * (after[x] == y) + FAILURE * (x == y)
        beliefs.append(updated(beliefs[-1], softmax(beta * q[:, x], axis=1) @ moved))
    return np.array(beliefs)


def action_beliefs(
    maze: Maze,
    q: Array,
    states: NDArray[np.int64],
    taken: NDArray[np.int64],
    actions: Sequence[Action],
    beta: float = OBSERVER_BETA,
    prior: Array | None = None,
) -> Array:
    """Beliefs of an observer who sees the actions as well: `b[t, n]`, shape (T + 1, N).

    b_t(n) is proportional to b_{t-1}(n) P(x' | x, a) pi_hat(a | x, n); P is the same for all
    goals and cancels: whether an action fails tells nothing. An action that no goal explains
    leaves the belief as it was. `taken` are indices `a` of `actions`, shape (T,).
    """
    if len(taken) != len(states) - 1:
        raise ModelError(
            f"expected one action fewer than states, came {len(taken)} for {len(states)} states"
        )
    beliefs = [_first_belief(q, prior)]
    after = maze.successors[:, list(actions)]
    for (x, y), a in zip(pairwise(states), taken, strict=True):
        if not 0 <= a < len(actions):
            raise ModelError(f"expected actions from 0 to {len(actions) - 1}, came {a}")
        if y not in (x, after[x, a]):
            raise ModelError(f"expected {actions[a].name} from {x} to stay or move, came to {y}")
        beliefs.append(updated(beliefs[-1], softmax(beta * q[:, x], axis=1)[:, a]))
    return np.array(beliefs)


def updated(belief: Array, likelihood: Array) -> Array:
    """Bayes' rule, shapes (N,); where all evidence is 0 the belief stays as it was."""
    evidence = belief * likelihood
    if evidence.sum() > 0:
        belief = evidence / evidence.sum()
    return belief


def belief_distance(beliefs: Array, goal: int, distance: Distance = "tv") -> Array:
    """Distance of beliefs `b[..., n]` to certainty of the goal with index `goal`, shape (...).

    `tv`: total variation 1 - b(g) (the paper prints a formula that is constant); `euclid`:
    ||b - b*||; `kl`: KL(b* || b) = -ln b(g), infinite where b(g) is 0.
    """
    _check_goal(beliefs, goal)
    if distance == "tv":
        far: Array = 1 - beliefs[..., goal]
    elif distance == "euclid":
        far = np.linalg.norm(beliefs - np.eye(beliefs.shape[-1])[goal], axis=-1)
    elif distance == "kl":
        with np.errstate(divide="ignore"):
            far = -np.log(beliefs[..., goal])
    else:
        expected = ", ".join(get_args(Distance))
        raise ModelError(f"expected a distance in {expected}; came {distance!r}")
    return far


def steps_until_sure(beliefs: Array, goal: int, threshold: float = 0.8) -> int:
    """Steps until the belief in the goal first exceeds the threshold; all of them if it never does.

    `beliefs[t, n]`; `goal` is the index n.
    """
    sure = beliefs[:, goal] > threshold
    return int(sure.argmax()) if sure.any() else len(beliefs) - 1


def _first_belief(q: Array, prior: Array | None) -> Array:
    N = len(q)
    return np.full(N, 1 / N) if prior is None else prior / prior.sum()


def _check_goal(beliefs: Array, goal: int) -> None:
    if not 0 <= goal < beliefs.shape[-1]:
        raise ModelError(f"expected a goal's index from 0 to {beliefs.shape[-1] - 1}, came {goal}")
