"""Compiled loops for distances in a maze and what follows from them: Q* and legible rewards.

`after[x, a]` is the cell that action a leads to when it does not fail; `moves[x, a]` are the first
four of them. Cells and places in tables are unsigned where they index: numba then leaves out the
question whether an index counts from the end, which would take a third of the time.
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
def breadth_first(moves: Integers, start: int, d: Integers, order: Integers) -> int:
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
            y = np.uint32(moves[x, a])
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
def fill_distances(moves: Integers, goals: Integers, d: Integers) -> tuple[int, int]:
    """Write the fewest moves to goal n into `d[n, x]`.

    Returns the least number of cells that reach a goal, and the largest distance.
    """
    order = np.empty(len(moves) + 1, np.int32)
    least, farthest = len(moves), 0
    for n in range(len(goals)):
        reached = breadth_first(moves, goals[n], d[n], order)
        least = min(least, reached)
        farthest = max(farthest, d[n, order[reached - 1]])
    return least, farthest


@njit(cache=True, nogil=True)
def place(k: int, onwards: int) -> int:
    """Where a table keeps what a move from distance k to `onwards` has: 3 places for each k."""
    return 3 * (k + 1) + (onwards - k + 1)


@njit(cache=True, nogil=True)
def value_tables(farthest: int, gamma: float, failure: float) -> tuple[Array, Array]:
    """V*(x) and Q*(x, a) of goals where the robot cannot stay (s = 0), and where it can (s = 1).

    `v[s, place(k, l)]` and `q[s, place(k, l)]` for a move from distance k to l = k - 1, k or
    k + 1. What no state has (at the goal, a move that comes nearer) is some finite value; where
    no way leads, k = l = -1, all is 0.
    """
    kappa = (1 - failure) * gamma / (1 - failure * gamma)
    power = np.empty(farthest + 2)
    for k in range(farthest + 2):
        # Of an integer power the compiler would make products, each rounded.
        power[k] = math.pow(kappa, float(k))
    v, q = np.zeros((2, 3 * farthest + 6)), np.zeros((2, 3 * farthest + 6))
    for s in range(2):
        loop = gamma if s else gamma * (failure + (1 - failure) * kappa)
        by_distance = power / (1 - loop)
        for k in range(farthest + 1):
            r = 1.0 if k == 0 else 0.0
            for onwards in range(k - 1, k + 2):
                later = failure * by_distance[k] + (1 - failure) * by_distance[max(onwards, 0)]
                v[s, place(k, onwards)] = by_distance[k]
                q[s, place(k, onwards)] = r + gamma * later
    return v, q


@njit(cache=True, nogil=True)
def log_weights(v: Array, q: Array, beta: float, less_v: bool) -> tuple[Array, float]:
    """beta Q or, if `less_v`, beta (Q - V), by place; and the largest distance from 0.

    Q is taken from its largest value, which every goal's posterior has in common.
    """
    log_w, largest = np.empty_like(q), 0.0
    top = q[1, place(0, 0)]
    for s in range(2):
        for i in range(q.shape[1]):
            log_w[s, i] = beta * (q[s, i] - (v[s, i] if less_v else top))
            largest = max(largest, abs(log_w[s, i]))
    return log_w, largest


@njit(cache=True, nogil=True)
def can_stay(moves: Integers, goals: Integers, A: int) -> Integers:
    """1 for a goal where some action leaves the robot (no-op, or a wall to run into), else 0."""
    s = np.full(len(goals), 1 if A > MOVES else 0, np.int8)
    for n in range(len(goals)):
        for a in range(MOVES):
            if moves[goals[n], a] == goals[n]:
                s[n] = 1
    return s


@njit(cache=True, nogil=True)
def gather(moves: Integers, d: Integers, s: Integers, table: Array, into: Array) -> None:
    """Fill `into[n, x, a]` from `table[s[n], place(k, l)]`, k and l the distances before and after.

    A move changes the distance by at most 1, so an action has one of three values per distance.
    Where no way leads (k = -1) it is an entry of the last distance, finite as all are.
    """
    N, S, A = into.shape
    for n in range(N):
        of_goal, values, filled = d[n], table[s[n]], into[n]
        for x in range(S):
            k = of_goal[x]
            for a in range(MOVES):
                onwards = of_goal[np.uint32(moves[x, a])]
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
    flat, total = w.reshape(N, S * A), np.zeros(S * A)
    for n in range(N):
        for i in range(S * A):
            total[i] += flat[n, i]
    share = 1 / total
    for n in range(N):
        for i in range(S * A):
            flat[n, i] *= share[i]


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
def nothing_in_closed_rooms(d: Integers, w: Array) -> None:
    """Write 0 into `w[n, x, a]` where no way leads to the goals, in place."""
    for x in range(w.shape[1]):
        if d[0, x] < 0:
            w[:, x] = 0


@njit(cache=True, nogil=True)
def fill_goal_values(
    after: Integers, goals: Integers, gamma: float, failure: float, q: Array
) -> int:
    """Write Q*_n into `q[n, x, a]`; the least number of cells that reach a goal."""
    moves, d = moves_only(after), np.empty(q.shape[:2], np.int32)
    least, farthest = fill_distances(moves, goals, d)
    table = value_tables(farthest, gamma, failure)[1]
    gather(moves, d, can_stay(moves, goals, q.shape[2]), table, q)
    return least


@njit(cache=True, nogil=True)
def fill_rewards(
    after: Integers,
    goals: Integers,
    gamma: float,
    failure: float,
    beta: float,
    less_v: bool,
    by_action: bool,
    log_prior: Array,
    q_and_r: Array,
) -> int:
    """Write Q*_n and the posterior of goal n into `q_and_r`, each [n, x, a].

    Goals weigh exp(beta Q_n), or exp(beta (Q_n - V_n)) if `less_v`; `by_action` first divides
    each goal's weights by their sum over actions; then goals weigh by their prior, (N,), whose
    logarithms count from those of the first. Cells that reach no goal have 0. Returns the least
    number of cells that reach a goal.
    """
    q, r_leg = q_and_r[0], q_and_r[1]
    moves, d = moves_only(after), np.empty(q.shape[:2], np.int32)
    least, farthest = fill_distances(moves, goals, d)
    s = can_stay(moves, goals, q.shape[2])
    v_table, q_table = value_tables(farthest, gamma, failure)
    gather(moves, d, s, q_table, q)
    log_w, largest = log_weights(v_table, q_table, beta, less_v)
    if largest + np.abs(log_prior).max() > LARGEST_EXPONENT:
        gather(moves, d, s, log_w, r_leg)
        if by_action:
            log_over_actions(r_leg)
        for n in range(len(goals)):
            r_leg[n] += log_prior[n]
        exp_over_goals(r_leg)
    else:
        gather(moves, d, s, np.exp(log_w), r_leg)
        if by_action:
            over_actions(r_leg)
        if log_prior.any():
            for n in range(len(goals)):
                r_leg[n] *= math.exp(log_prior[n])
        over_goals(r_leg)
    if least < len(moves):
        nothing_in_closed_rooms(d, r_leg)
    return least
