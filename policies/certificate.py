"""Does a policy arrive? From which starts, and within which multiple of the shortest path?"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, diags_array
from scipy.sparse.linalg import splu

from policies.maze import FAILURE, Action, Maze
from policies.mdp import Array
from policies.solvers import cells_after, distances_to

LARGEST_STRETCH = 4.0


@dataclass(frozen=True, eq=False)
class Certificate:
    """What is proved of a policy, per start.

    `arrives[x]`: the goal is reached with probability 1; `expected_steps[x]`: the mean number of
    steps until then (inf where it does not arrive); `stretch[x]`: that over the optimal policy's.
    `reaches_goal[x]`: a way leads there, as it does from everywhere but closed rooms, which are
    no starts.
    """

    reaches_goal: NDArray[np.bool_]
    arrives: NDArray[np.bool_]
    expected_steps: Array
    stretch: Array

    @property
    def holds_at(self) -> NDArray[np.bool_]:
        """The starts that arrive with a stretch of at most 4, shape (S,)."""
        return self.arrives & (self.stretch <= LARGEST_STRETCH)

    @property
    def fails_at(self) -> NDArray[np.bool_]:
        """The starts where it does not hold although a way leads to the goal, shape (S,)."""
        return self.reaches_goal & ~self.holds_at

    @property
    def certified(self) -> bool:
        """Whether it holds at every start."""
        return not self.fails_at.any()


def certify(maze: Maze, policy: Array, goal: int, actions: Sequence[Action]) -> Certificate:
    """Certificate of arrival of a policy (S, A) that stops on entering the goal.

    One pass: each state after those its actions lead to; only where states lead to one another
    are their expected steps a linear system.
    """
    from policies.certificate_kernels import components, expect_steps

    after = cells_after(maze, actions)
    order, ends = np.empty(maze.states, np.int32), np.empty(maze.states + 1, np.int32)
    ends = ends[: components(after, policy, goal, order, ends) + 1]
    steps = np.empty(maze.states)
    k = 0
    while True:
        k = expect_steps(after, policy, goal, 1 - FAILURE, order, ends, k, steps)
        if k == len(ends) - 1:
            break
        x = np.sort(order[ends[k] : ends[k + 1]])
        steps[x] = _steps_round(x, after[x], policy[x], steps)
        k += 1
    d = distances_to(maze, goal)
    stretch = np.where(d == 0, 1.0, np.inf)
    np.divide(steps, d / (1 - FAILURE), out=stretch, where=d > 0)
    return Certificate(d >= 0, np.isfinite(steps), steps, stretch)


def _steps_round(
    x: NDArray[np.int32], after: NDArray[np.int64], policy: Array, steps: Array
) -> Array:
    """Expected steps from the k states `x`, in order, that lead to one another; (k, A) of each.

    `steps` holds those of all they lead to besides.
    """
    place = np.searchsorted(x, after).clip(max=len(x) - 1)
    taken, inside = policy > 0, x[place] == after
    moves = taken & (after != x[:, None])
    out = taken & ~inside
    onwards = np.where(out, policy * np.where(out, steps[after], 0), 0).sum(axis=1)
    if not out.any() or np.isinf(onwards).any():
        return np.full(len(x), np.inf)
    row, a = np.nonzero(moves & inside)
    within = coo_array((policy[row, a], (row, place[row, a])), (len(x), len(x)))
    moving = np.where(moves, policy, 0).sum(axis=1)
    # Ways out may have chances too small beside the others for numbers to hold them: then the
    # system is singular, or its solution less than a single step, and nothing is proved.
    try:
        leaving = splu((diags_array(moving) - within).tocsc())
    except RuntimeError:
        return np.full(len(x), np.inf)
    expected: Array = leaving.solve(1 / (1 - FAILURE) + onwards)
    return expected if (expected >= 1).all() else np.full(len(x), np.inf)
