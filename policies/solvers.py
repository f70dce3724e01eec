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
    """Fewest moves from every state to every goal, shape (N, S); -1 in closed rooms.

    MazeError where no way leads from one goal to another.
    """
    d = np.stack([distances_to(maze, goal) for goal in maze.goals.values()])
    between = d[:, list(maze.goals.values())]
    if between.min() < 0:
        one, other = (maze.letters[n] for n in np.argwhere(between < 0)[0])
        raise MazeError(f"expected a way from goal {other} to {one}, found none")
    return d


def distances_to(maze: Maze, goal: int) -> NDArray[np.int32]:
    """Fewest moves from every state to one, shape (S,); -1 where no way leads."""
    from policies.maze_kernels import breadth_first

    d = np.empty(maze.states, np.int32)
    breadth_first(maze.successors, goal, d)
    return d


def goal_values(maze: Maze, gamma: float, actions: Sequence[Action]) -> Array:
    """Q*_n of every goal's MDP in closed form, `q[n, x, a]`, shape (N, S, A).

    The only chance in a maze is the self-loop of a failed action, so with d the distance to the
    goal and kappa = .85 gamma / (1 - .15 gamma), V_n(x) = kappa^d V_n(goal); V_n(goal) is
    1 / (1 - gamma) where the robot can stay there (no-op, or a wall to run into). In closed
    rooms all is 0.
    """
    d = distances(maze)
    q = gathered(cells_after(maze, actions), d, value_tables(maze, d, gamma, actions)[1])
    return nothing_in_closed_rooms(q, d)


def value_tables(
    maze: Maze, d: NDArray[np.int32], gamma: float, actions: Sequence[Action]
) -> tuple[Array, Array]:
    """V_n and Q*_n by distance k: `v[n, k]`, and `q[n, k, m]` for moves to k - 1, k and k + 1.

    What no state has (at the goal, a move that comes nearer) holds some finite value.
    """
    if not 0 <= gamma < 1:
        raise ModelError(f"expected gamma in [0, 1), came {gamma}")
    kappa = (1 - FAILURE) * gamma / (1 - FAILURE * gamma)
    goals = np.array(list(maze.goals.values()))
    can_stay = (maze.successors[goals][:, list(actions)] == goals[:, None]).any(axis=1)
    loop = np.where(can_stay, gamma, gamma * (FAILURE + (1 - FAILURE) * kappa))
    power = kappa ** np.maximum(np.arange(-1, d.max() + 2), 0)
    v = power / (1 - loop)[:, None]
    onwards = np.stack([v[:, :-2], v[:, 1:-1], v[:, 2:]], axis=2)
    q = gamma * (FAILURE * v[:, 1:-1, None] + (1 - FAILURE) * onwards)
    q[:, 0] += 1
    return v[:, 1:-1], q


def gathered(after: NDArray[np.int64], d: NDArray[np.int32], table: Array) -> Array:
    """The entries of a table by distance (N, D + 1, 3) for every goal, state and action."""
    from policies.maze_kernels import gather

    into = np.empty((len(d), *after.shape))
    gather(after, d, table, into)
    return into


def nothing_in_closed_rooms(values: Array, d: NDArray[np.int32]) -> Array:
    """Write 0 into `values[n, x, a]`, in place, where no way leads to the goals (d = -1)."""
    closed = d[0] < 0
    if closed.any():
        values[:, closed] = 0
    return values


def cells_after(maze: Maze, actions: Sequence[Action]) -> NDArray[np.int64]:
    """The cell each of the actions leads to when it does not fail, shape (S, A)."""
    return np.ascontiguousarray(maze.successors[:, list(actions)])


def shortest_path_policy(maze: Maze, goal: int, actions: Sequence[Action]) -> Array:
    """The optimal policy of one goal, (S, A): actions that lower the distance; at the goal, stay.

    Where no way leads to the goal all actions are as good. Read off the distances, never off Q:
    far from the goal the Q values of all actions are equal to machine precision.
    """
    d = distances_to(maze, goal)
    after = cells_after(maze, actions)
    nearest = d[after].min(axis=1, keepdims=True)
    return uniform_over(d[after] == nearest)
