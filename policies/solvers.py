"""Exact solvers: one for any MDP, one in closed form for goals in a maze."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import eye_array
from scipy.sparse.linalg import spsolve

from policies.errors import MazeError, ModelError
from policies.maze import FAILURE, Action, Maze
from policies.mdp import MDP, Array, policy_transitions, uniform_over

TIE = 1e-12
"""Relative difference up to which two action values are a tie."""


@dataclass(frozen=True, eq=False)
class Solution:
    """Optimal values and policy of an MDP.

    `q[x, a]`, `v[x]`, `policy[x, a]` (ties share uniformly); `bound` is the certified largest
    error of `v`: the Bellman residual / (1 - gamma).
    """

    q: Array
    v: Array
    policy: Array
    bound: float


def solve(mdp: MDP) -> Solution:
    """Policy iteration with exact evaluation; an action is replaced only by one better than a tie.

    Source: Howard (1960); Puterman (1994), section 6.4. The tie tolerance is what makes it end
    on mazes, where many actions are exactly equal; a choice that comes back ends it anyhow.
    """
    states = np.arange(len(mdp.r))
    chosen = mdp.r.argmax(axis=1)
    tried: set[bytes] = set()
    while True:
        tried.add(chosen.tobytes())
        policy = np.zeros_like(mdp.r)
        policy[states, chosen] = 1
        v = evaluate(mdp, policy)
        q = mdp.q(v)
        better = ~ties(q)[states, chosen]
        chosen = np.where(better, q.argmax(axis=1), chosen)
        # Rounding can call actions better in turn; a policy met again is as good as it gets.
        if chosen.tobytes() in tried:
            break
    bound = float(np.abs(q.max(axis=1) - v).max()) / (1 - mdp.gamma)
    return Solution(q, v, uniform_over(ties(q)), bound)


def evaluate(mdp: MDP, policy: Array) -> Array:
    """The exact value of a policy: solves (I - gamma P_pi) v = r_pi, shape (S,)."""
    r = (policy * mdp.r).sum(axis=1)
    chain = policy_transitions(mdp.P, policy)
    v: Array = spsolve((eye_array(len(r)) - mdp.gamma * chain).tocsc(), r)
    return v


def ties(q: Array) -> NDArray[np.bool_]:
    """The actions whose value is the state's best, up to a relative difference of `TIE`, (S, A)."""
    best = q.max(axis=1, keepdims=True)
    tied: NDArray[np.bool_] = q >= best - TIE * np.abs(best)
    return tied


def distances(maze: Maze) -> NDArray[np.int32]:
    """Fewest moves from every state to every goal, shape (N, S); MazeError where no way leads."""
    return _distances(maze, goal_states(maze))


def distances_to(maze: Maze, goal: int) -> NDArray[np.int32]:
    """Fewest moves from every state to one, shape (S,); MazeError where no way leads."""
    d: NDArray[np.int32] = _distances(maze, np.array([goal]))[0]
    return d


def _distances(maze: Maze, goals: NDArray[np.int64]) -> NDArray[np.int32]:
    from policies.maze_kernels import fill_distances, moves_only

    d = np.empty((len(goals), maze.states), np.int32)
    if fill_distances(moves_only(maze.successors), goals, d)[0] < maze.states:
        n, x = divmod(int(d.argmin()), maze.states)
        raise MazeError(
            f"expected cell {maze.cell(int(goals[n]))} to be reachable from every cell, "
            f"found no way from {maze.cell(x)} (row, column)"
        )
    return d


def goal_values(maze: Maze, gamma: float, actions: Sequence[Action]) -> Array:
    """Q*_n of every goal's MDP in closed form, `q[n, x, a]`, shape (N, S, A).

    The only chance in a maze is the self-loop of a failed action, so with d the distance to the
    goal and kappa = .85 gamma / (1 - .15 gamma), V_n(x) = kappa^d V_n(goal); V_n(goal) is
    1 / (1 - gamma) where the robot can stay there (no-op, or a wall to run into).
    """
    from policies.maze_kernels import fill_goal_values

    check_discount(gamma)
    q = np.empty((len(maze.goals), maze.states, len(actions)))
    if fill_goal_values(maze.successors, goal_states(maze), gamma, FAILURE, q) < maze.states:
        distances(maze)  # says which
    return q


def check_discount(gamma: float) -> None:
    """ModelError unless gamma is in [0, 1)."""
    if not 0 <= gamma < 1:
        raise ModelError(f"expected gamma in [0, 1), came {gamma}")


def goal_states(maze: Maze) -> NDArray[np.int64]:
    """The states of the maze's goals, in their order, shape (N,)."""
    return np.array(list(maze.goals.values()))


def cells_after(maze: Maze, actions: Sequence[Action]) -> NDArray[np.int64]:
    """The cell each of the actions, moves first, leads to when it does not fail, shape (S, A)."""
    return np.ascontiguousarray(maze.successors[:, : len(actions)])


def shortest_path_policy(maze: Maze, goal: int, actions: Sequence[Action]) -> Array:
    """The optimal policy of one goal, (S, A): actions that lower the distance; at the goal, stay.

    Read off the distances, never off Q: far from the goal the Q values of all actions are equal
    to machine precision.
    """
    d = distances_to(maze, goal)
    after = cells_after(maze, actions)
    nearest = d[after].min(axis=1, keepdims=True)
    return uniform_over(d[after] == nearest)
