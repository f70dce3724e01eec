"""Does a policy arrive? From which starts, and within which multiple of the shortest path?"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, eye_array
from scipy.sparse.csgraph import dijkstra
from scipy.sparse.linalg import spsolve

from policies.maze import FAILURE, Action, Maze
from policies.mdp import Array, maze_transitions, policy_transitions

LARGEST_STRETCH = 4.0


@dataclass(frozen=True, eq=False)
class Certificate:
    """What is proved of a policy, per start.

    `arrives[x]`: the goal is reached with probability 1; `expected_steps[x]`: the mean number of
    steps until then (inf where it does not arrive); `stretch[x]`: that over the optimal policy's.
    """

    arrives: NDArray[np.bool_]
    expected_steps: Array
    stretch: Array

    @property
    def holds_at(self) -> NDArray[np.bool_]:
        """The starts that arrive with a stretch of at most 4, shape (S,)."""
        return self.arrives & (self.stretch <= LARGEST_STRETCH)

    @property
    def certified(self) -> bool:
        """Whether it holds at every start."""
        return bool(self.holds_at.all())


def certify(maze: Maze, policy: Array, goal: int, actions: Sequence[Action]) -> Certificate:
    """Certificate of arrival of a policy (S, A) that stops on entering the goal."""
    chain = policy_transitions(maze_transitions(maze, actions), policy)
    at_goal = np.arange(maze.states) == goal
    lost = ~_can_enter(chain, at_goal)
    arrives = ~_can_enter(chain, lost, never_through=at_goal)
    steps = np.full(maze.states, np.inf)
    steps[goal] = 0
    on_the_way = np.flatnonzero(arrives & ~at_goal)
    if len(on_the_way):
        within = chain[on_the_way][:, on_the_way]
        leave = (eye_array(len(on_the_way)) - within).tocsc()
        steps[on_the_way] = spsolve(leave, np.ones(len(on_the_way)))
    fewest = dijkstra(maze.edges.tocsr(), unweighted=True, indices=[goal])[0] / (1 - FAILURE)
    stretch = np.divide(steps, fewest, out=np.ones(maze.states), where=~at_goal)
    return Certificate(arrives, steps, stretch)


def _can_enter(
    chain: csr_array, target: NDArray[np.bool_], never_through: NDArray[np.bool_] | None = None
) -> NDArray[np.bool_]:
    """The states from which the chain enters `target` with a probability above 0."""
    blocked = np.zeros_like(target) if never_through is None else never_through
    entered = target
    while True:
        grown = (entered | (chain @ entered > 0)) & ~blocked
        if (grown == entered).all():
            return entered
        entered = grown
