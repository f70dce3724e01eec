"""Markov decision processes with sparse transitions, and the maze as one of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from policies.errors import ModelError
from policies.maze import FAILURE, Action, Maze

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MDP:
    """States, actions, transitions `P`, rewards `r` and discount `gamma`.

    `P` has shape (A * S, S): row a * S + x is the distribution P(. | x, a). `r[x, a]` has shape
    (S, A). ModelError when shapes disagree, a row does not sum to 1, or gamma is outside [0, 1).
    """

    P: csr_array
    r: Array
    gamma: float

    def __post_init__(self) -> None:
        S, A = self.r.shape
        if self.P.shape != (A * S, S):
            raise ModelError(
                f"expected P of shape {(A * S, S)} for r {(S, A)}, came {self.P.shape}"
            )
        if not 0 <= self.gamma < 1:
            raise ModelError(f"expected gamma in [0, 1), came {self.gamma}")
        off = np.abs(self.P.sum(axis=1) - 1)
        if (self.P.nnz and self.P.data.min() < 0) or off.max() > 1e-9:
            a, x = divmod(int(off.argmax()), S)
            raise ModelError(f"expected P(. | x, a) to be a distribution; not so at x={x}, a={a}")
        if not np.isfinite(self.r).all():
            raise ModelError("expected finite rewards r")

    def q(self, v: Array) -> Array:
        """One backup: q[x, a] = r[x, a] + gamma sum_y P(y | x, a) v[y]."""
        S, A = self.r.shape
        backed_up: Array = (self.P @ v).reshape(A, S).T
        return self.r + self.gamma * backed_up


def policy_transitions(P: csr_array, policy: Array) -> csr_array:
    """The Markov chain of a policy: sum_a pi(a | x) P(. | x, a), shape (S, S)."""
    S, A = policy.shape
    weight = policy.T.ravel()
    taken = np.flatnonzero(weight)
    choose = coo_array((weight[taken], (taken % S, taken)), (S, A * S))
    return csr_array(choose.tocsr() @ P)


def uniform_over(best: NDArray[np.bool_]) -> Array:
    """A policy that shares probability uniformly over the marked actions of each state, (S, A)."""
    policy: Array = best / best.sum(axis=1, keepdims=True)
    return policy


def maze_transitions(maze: Maze, actions: Sequence[Action]) -> csr_array:
    """P of the maze, (A * S, S): an action fails with probability .15, a wall always stops."""
    x = np.tile(np.arange(maze.states), len(actions))
    y = maze.successors[:, list(actions)].T.ravel()
    row = np.arange(len(x))
    moved = np.full(len(x), 1 - FAILURE)
    stayed = np.full(len(x), FAILURE)
    entries = (np.concatenate([moved, stayed]), (np.tile(row, 2), np.concatenate([y, x])))
    return coo_array(entries, (len(x), maze.states)).tocsr()


def maze_mdp(maze: Maze, goal: int, gamma: float, actions: Sequence[Action]) -> MDP:
    """One goal's MDP: reward 1 for every action taken in its cell, else 0 (paper, 4.1)."""
    r = np.zeros((maze.states, len(actions)))
    r[goal] = 1.0
    return MDP(maze_transitions(maze, actions), r, gamma)
