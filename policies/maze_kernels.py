"""Compiled loops for distances in a maze and what follows from them: Q* and legible rewards.

`after[x, a]` is the cell that action a leads to when it does not fail; the first four actions are
the moves. Cells and places in tables are unsigned where they index: numba then leaves out the
question whether an index counts from the end, a third of the time.
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from policies.mdp import Array

Integers = NDArray[np.integer]

MOVES = 4
LARGEST_EXPONENT = 600.0
"""Up to this, exp(beta Q) keeps its full precision; beyond, posteriors stay in log space."""


@njit(cache=True, nogil=True)
def breadth_first(after: Integers, start: int, d: Integers, order: Integers) -> int:
    """Write the fewest moves to `start` into `d`, -1 where no way leads; the cells reached.

    `order`, of one entry more than there are cells, gets those cells, the nearest first.
    """
    d[:] = -1
    d[start] = 0
    order[0] = start
    first, last = 0, 1
    while first < last:
        x = np.uint32(order[first])
        farther = d[x] + 1
        first += 1
        for a in range(MOVES):
            # Without a branch: whether a cell is new cannot be predicted, and guesses cost more.
            y = np.uint32(after[x, a])
            new = d[y] < 0
            d[y] = farther if new else d[y]
            order[np.uint32(last)] = y
            last += new
    return last


@njit(cache=True, nogil=True)
def moves_only(after: Integers) -> Integers:
    """Where moves lead, (S, 4), in a third of the memory: in large mazes that is half the time."""
    return after[:, :MOVES].astype(np.int32)


@njit(cache=True, nogil=True)
def fill_distances(after: Integers, goals: Integers, d: Integers) -> int:
    """Write the fewest moves to goal n into `d[n, x]`; the least number of cells that reach one."""
    moves, order = moves_only(after), np.empty(len(after) + 1, np.int32)
    least = len(after)
    for n in range(len(goals)):
        least = min(least, breadth_first(moves, goals[n], d[n], order))
    return least


@njit(cache=True, nogil=True)
def place(k: int, onwards: int) -> int:
    """Where a table keeps what a move from distance k to `onwards` has: 3 places for each k."""
    return 3 * (k + 1) + (onwards - k + 1)


@njit(cache=True, nogil=True)
def value_tables(farthest: int, gamma: float, failure: float) -> tuple[Array, Array]:
    """V* and Q* by distance, of goals where the robot cannot stay (s = 0) and where it can (s = 1).

    `v[s, k]` for distance k, `q[s, place(k, l)]` for a move from k to l = k - 1, k or k + 1. What
    no state has (at the goal, a move that comes nearer) holds some finite value; where no way
    leads, k = l = -1, the value is 0.
    """
    kappa = (1 - failure) * gamma / (1 - failure * gamma)
    loops = gamma * (failure + (1 - failure) * kappa), gamma
    v, q = np.empty((2, farthest + 2)), np.zeros((2, place(farthest + 1, farthest)))
    for k in range(farthest + 2):
        power = math.pow(kappa, k)
        for s in range(2):
            v[s, k] = power / (1 - loops[s])
    for s in range(2):
        for k in range(farthest + 1):
            r = 1.0 if k == 0 else 0.0
            for onwards in range(k - 1, k + 2):
                later = failure * v[s, k] + (1 - failure) * v[s, max(onwards, 0)]
                q[s, place(k, onwards)] = r + gamma * later
    return v, q


@njit(cache=True, nogil=True)
def can_stay(after: Integers, goals: Integers) -> Integers:
    """1 for a goal where some action leaves the robot (no-op, or a wall to run into), else 0."""
    s = np.zeros(len(goals), np.int8)
    for n in range(len(goals)):
        for a in range(after.shape[1]):
            if after[goals[n], a] == goals[n]:
                s[n] = 1
    return s


@njit(cache=True, nogil=True)
def gather(after: Integers, d: Integers, s: Integers, table: Array, into: Array) -> None:
    """Fill `into[n, x, a]` from `table[s[n], place(k, l)]`, k and l the distances before and after.

    A move changes the distance by at most 1, so an action has one of three values per distance.
    """
    N, S, A = into.shape
    for n in range(N):
        of_goal, values, filled = d[n], table[s[n]], into[n]
        for x in range(S):
            k = of_goal[x]
            for a in range(MOVES):
                onwards = of_goal[np.uint32(after[x, a])]
                filled[x, a] = values[np.uint32(place(k, onwards))]
            for a in range(MOVES, A):
                filled[x, a] = values[np.uint32(place(k, k))]


@njit(cache=True, nogil=True)
def over_actions(w: Array) -> None:
    """Normalise weights `w[n, x, a]` over actions, in place."""
    N, S, A = w.shape
    for n in range(N):
        for x in range(S):
            total = 0.0
            for a in range(A):
                total += w[n, x, a]
            for a in range(A):
                w[n, x, a] /= total


@njit(cache=True, nogil=True)
def over_goals(w: Array) -> None:
    """Normalise weights `w[n, x, a]` over goals, in place."""
    N, S, A = w.shape
    flat = w.reshape(N, S * A)
    for i in range(S * A):
        total = 0.0
        for n in range(N):
            total += flat[n, i]
        share = 1 / total
        for n in range(N):
            flat[n, i] *= share


@njit(cache=True, nogil=True)
def log_over_actions(w: Array) -> None:
    """Normalise logarithms of weights `w[n, x, a]` over actions, in place; they stay logarithms."""
    N, S, A = w.shape
    for n in range(N):
        for x in range(S):
            top = -math.inf
            for a in range(A):
                top = max(top, w[n, x, a])
            total = 0.0
            for a in range(A):
                total += math.exp(w[n, x, a] - top)
            for a in range(A):
                w[n, x, a] -= top + math.log(total)


@njit(cache=True, nogil=True)
def exp_over_goals(w: Array) -> None:
    """Turn logarithms of weights `w[n, x, a]` into shares of each goal, in place."""
    N, S, A = w.shape
    for x in range(S):
        for a in range(A):
            top = -math.inf
            for n in range(N):
                top = max(top, w[n, x, a])
            for n in range(N):
                w[n, x, a] = math.exp(w[n, x, a] - top)
    over_goals(w)


@njit(cache=True, nogil=True)
def fill_goal_values(
    after: Integers, goals: Integers, d: Integers, gamma: float, failure: float, q: Array
) -> None:
    """Write Q*_n into `q[n, x, a]`."""
    table = value_tables(d.max(), gamma, failure)[1]
    gather(after, d, can_stay(after, goals), table, q)


@njit(cache=True, nogil=True)
def fill_rewards(
    after: Integers,
    goals: Integers,
    d: Integers,
    gamma: float,
    failure: float,
    beta: float,
    less_v: bool,
    by_action: bool,
    q: Array,
    r_leg: Array,
) -> None:
    """Write Q*_n into `q[n, x, a]` and the posterior of goal n into `r_leg[n, x, a]`.

    Goals weigh exp(beta Q_n), or exp(beta (Q_n - V_n)) if `less_v`; `by_action` first divides
    each goal's weights by their sum over actions.
    """
    s = can_stay(after, goals)
    v, table = value_tables(d.max(), gamma, failure)
    gather(after, d, s, table, q)
    weights = beta * (table - table.max())
    if less_v:
        for i in range(table.size // 2):
            k = i // 3 - 1
            for j in range(2):
                weights[j, i] = beta * (table[j, i] - v[j, k]) if k >= 0 else 0.0
    if weights.min() < -LARGEST_EXPONENT or weights.max() > LARGEST_EXPONENT:
        gather(after, d, s, weights, r_leg)
        if by_action:
            log_over_actions(r_leg)
        exp_over_goals(r_leg)
    else:
        gather(after, d, s, np.exp(weights), r_leg)
        if by_action:
            over_actions(r_leg)
        over_goals(r_leg)
