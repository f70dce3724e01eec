"""Compiled loops for the values of a maze with rewards `r[x, a]`.

Waiting until a move succeeds makes it one that never fails, earns `scale` times its reward and is
discounted by 1 - `leak`: a graph without chance. Its cells are numbered i by breadth-first order
from one of them, so that what is near in the maze is near in memory: move a leads from i to
`to[i, a]` and earns `c[i, a]`, -inf at walls; `stay[i]` is the most that staying earns. Moves are
up, down, left, right, so that `a ^ 1` leads back to where `a` came from.
"""

import math

import numpy as np
from numba import njit

from policies.maze_kernels import MOVES, Integers, breadth_first, moves_only
from policies.mdp import Array

STAY = MOVES
"""The choice to stay, beside the four moves."""

ROUNDING = 8 * np.finfo(float).eps
"""Relative gain up to which a value is as good as floating point makes it."""

ROUNDS = 100
"""Policy iteration ends after a few; rounding must not keep it going."""

MOST_SWEEPS = 16
"""Where as many do not do, values chase each other around longer cycles."""

FEW = 1 / 32
"""Share of cells that a sweep must raise to be worth its time."""

MOST_TAKEN = 4
"""Cells are taken up once each as a rule; beyond so many times, exact evaluation is faster."""


@njit(cache=True, nogil=True)
def optimise(after: Integers, r: Array, gamma: float, failure: float, v: Array, q: Array) -> float:
    """Write the optimal values, without an end, into `v[x]` and `q[x, a]`; returns their bound, nan
    if a reward is not finite.

    Values spread from cells where the robot stays, or goes to and fro between two. Where longer
    cycles pay the residual shows it: there the greedy policy is evaluated exactly, as in policy
    iteration (Howard, 1960), and values spread again from what it is worth.
    """
    scale = 1 / (1 - failure * gamma)
    leak = scale * (1 - gamma)
    # Any cell is good to begin from; from where values are high, fewer sweeps are needed.
    order, to, c, stay = graph(after, r, scale, int(r[:, -1].argmax()))
    values = start_values(to, c, stay, leak)
    best = np.empty(len(v), np.int8)
    residual = math.inf
    for _ in range(ROUNDS):
        raise_values(to, c, leak, values)
        residual, more = improve(to, c, stay, leak, values, best)
        if not more:
            break
        evaluate_choice(to, c, stay, leak, best, values)
    for i in range(len(v)):
        v[order[i]] = values[i]
    finite = back_up(after, r, gamma, failure, v, q)
    return residual / leak if finite else math.nan


@njit(cache=True, nogil=True)
def least_cost(after: Integers, cost: Array, failure: float, goal: int, v: Array) -> None:
    """Write the least expected undiscounted `cost[x, a]` until the goal into `v`; inf: no way."""
    order, to, c, _ = graph(after, cost, -1 / (1 - failure), goal)
    values = np.full(len(v), -math.inf)
    values[0] = 0
    raise_values(to, c, 0.0, values)
    for i in range(len(v)):
        v[order[i]] = abs(values[i])


@njit(cache=True, nogil=True)
def graph(
    after: Integers, r: Array, scale: float, first: int
) -> tuple[Integers, Integers, Array, Array]:
    """The graph as above, breadth-first from cell `first`: its cells in order, to, c and stay."""
    S, A = r.shape
    order, d, place = np.empty(S + 1, np.int32), np.empty(S, np.int32), np.empty(S, np.int32)
    reached = breadth_first(moves_only(after), first, d, order)
    for x in range(S):
        if d[x] < 0:
            order[reached] = x
            reached += 1
    for i in range(S):
        place[order[i]] = i
    to, c, stay = np.empty((S, MOVES), np.int32), np.empty((S, MOVES)), np.empty(S)
    for i in range(S):
        x = order[i]
        most = -math.inf
        for a in range(MOVES):
            earned, wall = scale * r[x, a], after[x, a] == x
            to[i, a] = place[after[x, a]]
            c[i, a] = -math.inf if wall else earned
            most = max(most, earned if wall else -math.inf)
        for a in range(MOVES, A):
            most = max(most, scale * r[x, a])
        stay[i] = most
    return order[:S], to, c, stay


@njit(cache=True, nogil=True)
def start_values(to: Integers, c: Array, stay: Array, leak: float) -> Array:
    """The best of staying for ever and of going to and fro between two cells for ever."""
    v = np.empty(len(stay))
    for i in range(len(v)):
        there_and_back = -math.inf
        for a in range(MOVES):
            back = c[np.uint32(to[i, a]), a ^ 1]
            there_and_back = max(there_and_back, c[i, a] + (1 - leak) * back)
        v[i] = max(stay[i] / leak, there_and_back / (leak * (2 - leak)))
    return v


@njit(cache=True, nogil=True)
def raise_values(to: Integers, c: Array, leak: float, v: Array) -> None:
    """Raise values to those of the best moves: by sweeps, then those still too low one by one.

    Sweeps go towards the first cell and away from it in turn: in a maze without circles the first
    two find all values.
    """
    S = len(v)
    for number in range(MOST_SWEEPS):
        if sweep(to, c, leak, v, number % 2 == 0) < FEW * S:
            break
    spread(to, c, leak, v, raising(to, c, leak, v), MOST_TAKEN * S)


@njit(cache=True, nogil=True)
def sweep(to: Integers, c: Array, leak: float, v: Array, backwards: bool) -> int:
    """Raise the value of one cell after the other to that of its best move; how many rose."""
    S = len(v)
    rose = 0
    for j in range(S):
        i = np.uint32(S - 1 - j if backwards else j)
        highest = v[i]
        for a in range(MOVES):
            onwards = v[np.uint32(to[i, a])]
            # Adding the difference keeps equal values exactly equal where all rewards are.
            value = onwards + (c[i, a] - leak * onwards)
            highest = value if value > highest else highest
        rose += highest > v[i]
        v[i] = highest
    return rose


@njit(cache=True, nogil=True)
def raising(to: Integers, c: Array, leak: float, v: Array) -> Integers:
    """The cells that raise a neighbour's value and that no neighbour raises.

    Whatever else is too low will be raised, and looked at, in consequence of these.
    """
    cells = np.empty(len(v) + 1, np.int32)
    count = 0
    for i in range(len(v)):
        raises, raised = False, False
        for a in range(MOVES):
            y = np.uint32(to[i, a])
            raised |= v[y] + (c[i, a] - leak * v[y]) > v[i]
            raises |= v[i] + (c[y, a ^ 1] - leak * v[i]) > v[y]
        cells[np.uint32(count)] = i
        count += raises & (not raised)
    return cells[:count]


@njit(cache=True, nogil=True)
def rise(heap: Integers, key: Array, place: Integers, i: int, x: int, v: float) -> None:
    """Put x with key v at place i of a 4-ary heap, or further up where it belongs."""
    while i > 0:
        above = (i - 1) >> 2
        if key[above] >= v:
            break
        heap[i], key[i] = heap[above], key[above]
        place[heap[i]] = i
        i = above
    heap[i], key[i], place[x] = x, v, i


@njit(cache=True, nogil=True)
def sink(heap: Integers, key: Array, place: Integers, size: int) -> None:
    """Move the heap's last entry, at `size`, to the top and from there down to where it belongs."""
    x, v, i = heap[size], key[size], 0
    while 4 * i + 1 < size:
        largest = 4 * i + 1
        for below in range(largest + 1, min(largest + 4, size)):
            if key[below] > key[largest]:
                largest = below
        if key[largest] <= v:
            break
        heap[i], key[i] = heap[largest], key[largest]
        place[heap[i]] = i
        i = largest
    heap[i], key[i], place[x] = x, v, i


@njit(cache=True, nogil=True)
def spread(to: Integers, c: Array, leak: float, v: Array, first: Integers, most: int) -> None:
    """Raise the values of neighbours, those of the highest cell first, beginning with `first`.

    Cells that are raised wait in a heap. As a rule each cell is final when it is taken up
    (Dijkstra's label setting); where the order was wrong it is taken up again, `most` times in
    all. Whoever calls checks the residual.
    """
    S = len(v)
    heap, key = np.empty(S, np.int32), np.empty(S)
    place = np.full(S, -1, np.int32)
    size = 0
    for i in first:
        rise(heap, key, place, size, i, v[i])
        size += 1
    for _ in range(most):
        if size == 0:
            break
        i = heap[0]
        place[i] = -1
        size -= 1
        if size > 0:
            sink(heap, key, place, size)
        for a in range(MOVES):
            y = to[i, a]
            raised = v[i] + (c[y, a ^ 1] - leak * v[i])
            if raised > v[y] and y != i:
                v[y] = raised
                if place[y] < 0:
                    place[y] = size
                    size += 1
                rise(heap, key, place, place[y], y, raised)


@njit(cache=True, nogil=True)
def improve(
    to: Integers, c: Array, stay: Array, leak: float, v: Array, best: Integers
) -> tuple[float, bool]:
    """Write each cell's best choice; largest Bellman residual, and whether more than rounding."""
    residual, more = 0.0, False
    for i in range(len(v)):
        gain, choice = stay[i] / leak - v[i], STAY
        for a in range(MOVES):
            onwards = v[np.uint32(to[i, a])]
            new = (c[i, a] - leak * onwards) + (onwards - v[i])
            choice = a if new > gain else choice
            gain = new if new > gain else gain
        best[i] = choice
        residual = max(residual, abs(gain))
        more |= gain > ROUNDING * abs(v[i])
    return residual, more


@njit(cache=True, nogil=True)
def evaluate_choice(
    to: Integers, c: Array, stay: Array, leak: float, choice: Integers, v: Array
) -> None:
    """Write the exact value of always taking `choice[i]` into `v`.

    Each cell has one way on, so every way ends in a cycle (of one cell, if the robot stays there),
    whose value is a geometric series; the values of all that leads there follow backwards.
    """
    S = len(v)
    onwards, earned = np.empty(S, np.int32), np.empty(S)
    for i in range(S):
        a = choice[i]
        onwards[i], earned[i] = (i, stay[i]) if a == STAY else (to[i, a], c[i, a])
    seen = np.full(S, -1, np.int32)
    way = np.empty(S, np.int32)
    for start in range(S):
        i, length = start, 0
        while seen[i] < 0:
            seen[i] = start
            way[length] = i
            length += 1
            i = onwards[i]
        if length > 0 and seen[i] == start:
            total, weights, weight, y = 0.0, 0.0, 1.0, i
            while weights == 0 or y != i:
                total += weight * earned[y]
                weights += weight
                weight *= 1 - leak
                y = onwards[y]
            v[i] = total / (leak * weights)
        for j in range(length - 1, -1, -1):
            y, z = way[j], onwards[way[j]]
            v[y] = v[z] + (earned[y] - leak * v[z])


@njit(cache=True, nogil=True)
def back_up(after: Integers, r: Array, gamma: float, failure: float, v: Array, q: Array) -> bool:
    """Write q[x, a] = r[x, a] + gamma E[v(x')] of values v; whether all are finite."""
    finite = True
    S, A = r.shape
    for x in range(S):
        for a in range(A):
            later = failure * v[x] + (1 - failure) * v[np.uint32(after[x, a])]
            q[x, a] = r[x, a] + gamma * later
            finite &= math.isfinite(q[x, a])
    return finite
