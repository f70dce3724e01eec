"""Compiled loops for the optimal values of a maze with rewards `r[x, a]` and no end.

`after[x, a]` is the cell that action a leads to when it does not fail. The first four actions
are up, down, left, right, so that `a ^ 1` leads back to where `a` came from. A move that never
fails earns `scale` times its reward and is discounted by 1 - `leak`. Cells are unsigned where they
index: see maze_kernels.
"""

import math

import numpy as np
from numba import njit

from policies.maze_kernels import MOVES, Integers, breadth_first
from policies.mdp import Array

ROUNDING = 8 * np.finfo(float).eps
"""Relative gain up to which a value is as good as floating point makes it."""

ROUNDS = 100
"""Policy iteration ends after a few; rounding must not keep it going."""

MOST_SWEEPS = 16
"""Where as many sweeps do not do, values chase each other around longer cycles."""

FEW = 1 / 32
"""Share of cells that a sweep must raise to be worth its time; fewer are raised one by one."""

MOST_TAKEN = 4
"""Cells are taken up once each as a rule; beyond so many times, exact evaluation is faster."""


@njit(cache=True, nogil=True)
def optimise(after: Integers, r: Array, gamma: float, failure: float, v: Array, q: Array) -> float:
    """Write optimal values into `v[x]` and `q[x, a]`; returns the largest error of v, certified.

    Values spread from cells where the robot stays, or goes to and fro between two. Where longer
    cycles pay the residual shows it: there the greedy policy is evaluated exactly, as in policy
    iteration (Howard, 1960), and values spread again from what it is worth.
    """
    scale = 1 / (1 - failure * gamma)
    leak = scale * (1 - gamma)
    best = np.empty(len(v), np.int8)
    residual = math.inf
    start_values(after, r, scale, leak, v)
    for _ in range(ROUNDS):
        sweep_all(after, r, scale, leak, v)
        spread(after, r, scale, leak, v, raising(after, r, scale, leak, v), MOST_TAKEN * len(v))
        residual, more = improve(after, r, scale, leak, v, best)
        if not more:
            break
        evaluate_choice(after, r, scale, leak, best, v)
    back_up(after, r, gamma, failure, v, q)
    return residual / leak


@njit(cache=True, nogil=True)
def start_values(after: Integers, r: Array, scale: float, leak: float, v: Array) -> None:
    """Write the best of staying for ever and of going to and fro between two cells for ever."""
    S, A = r.shape
    for x in range(S):
        staying, there_and_back = -math.inf, -math.inf
        for a in range(A):
            y = after[x, a]
            if y == x:
                staying = max(staying, scale * r[x, a])
            else:
                back = scale * r[y, a ^ 1]
                there_and_back = max(there_and_back, scale * r[x, a] + (1 - leak) * back)
        v[x] = max(staying / leak, there_and_back / (leak * (2 - leak)))


@njit(cache=True, nogil=True)
def sweep_all(after: Integers, r: Array, scale: float, leak: float, v: Array) -> None:
    """Raise values to those of the best move, cell by cell, as long as that raises many.

    Sweeps go towards the cell of the highest value and away from it in turn, in breadth-first
    order: in a maze without circles the first two find all values.
    """
    S = len(v)
    order, d = np.empty(S + 1, np.int32), np.empty(S, np.int32)
    reached = breadth_first(after, v.argmax(), d, order)
    for sweep in range(MOST_SWEEPS):
        raised = 0
        for i in range(reached):
            x = np.uint32(order[i if sweep % 2 else reached - 1 - i])
            highest = v[x]
            for a in range(MOVES):
                onwards = v[np.uint32(after[x, a])]
                # Adding the difference keeps equal values exactly equal where all rewards are.
                new = onwards + (scale * r[x, a] - leak * onwards)
                highest = new if new > highest else highest
            raised += highest > v[x]
            v[x] = highest
        if raised < FEW * reached:
            break


@njit(cache=True, nogil=True)
def raising(after: Integers, r: Array, scale: float, leak: float, v: Array) -> Integers:
    """The cells that raise a neighbour's value and that no neighbour raises.

    Whatever else is too low will be raised, and looked at, in consequence of these.
    """
    cells = np.empty(len(v), np.int32)
    count = 0
    for x in range(len(v)):
        raises, raised = False, False
        for a in range(MOVES):
            y = np.uint32(after[x, a])
            moves = y != x
            raised |= moves & (v[y] + (scale * r[x, a] - leak * v[y]) > v[x])
            raises |= moves & (v[x] + (scale * r[y, a ^ 1] - leak * v[x]) > v[y])
        cells[count] = x
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
def spread(
    after: Integers, r: Array, scale: float, leak: float, v: Array, first: Integers, most: int
) -> None:
    """Raise the values of neighbours, those of the highest cell first, beginning with `first`.

    Cells that are raised wait in a heap. As a rule each cell is final when it is taken up
    (Dijkstra's label setting); where the order was wrong it is taken up again, `most` times in
    all. Whoever calls checks the residual.
    """
    S = len(v)
    heap, key = np.empty(S, np.int32), np.empty(S)
    place = np.full(S, -1, np.int32)
    size = 0
    for x in first:
        rise(heap, key, place, size, x, v[x])
        size += 1
    for _ in range(most):
        if size == 0:
            break
        x = heap[0]
        place[x] = -1
        size -= 1
        if size > 0:
            sink(heap, key, place, size)
        for a in range(MOVES):
            y = after[x, a]
            raised = v[x] + (scale * r[y, a ^ 1] - leak * v[x])
            if y != x and raised > v[y]:
                v[y] = raised
                if place[y] < 0:
                    place[y] = size
                    size += 1
                rise(heap, key, place, place[y], y, raised)


@njit(cache=True, nogil=True)
def improve(
    after: Integers, r: Array, scale: float, leak: float, v: Array, best: Integers
) -> tuple[float, bool]:
    """Write each cell's best action; largest Bellman residual, and whether more than rounding."""
    S, A = r.shape
    residual, more = 0.0, False
    for x in range(S):
        gain = -math.inf
        for a in range(A):
            y = after[x, a]
            if y == x:
                new = scale * r[x, a] / leak - v[x]
            else:
                new = (scale * r[x, a] - leak * v[y]) + (v[y] - v[x])
            if new > gain:
                gain, best[x] = new, a
        residual = max(residual, abs(gain))
        more |= gain > ROUNDING * abs(v[x])
    return residual, more


@njit(cache=True, nogil=True)
def evaluate_choice(
    after: Integers, r: Array, scale: float, leak: float, choice: Integers, v: Array
) -> None:
    """Write the exact value of always taking `choice[x]` into `v`.

    Each cell has one way on, so every way ends in a cycle (of one cell, if the robot stays there),
    whose value is a geometric series; the values of all that leads there follow backwards.
    """
    S = len(v)
    seen = np.full(S, -1, np.int32)
    way = np.empty(S, np.int32)
    for start in range(S):
        x, length = start, 0
        while seen[x] < 0:
            seen[x] = start
            way[length] = x
            length += 1
            x = after[x, choice[x]]
        if length > 0 and seen[x] == start:
            total, weights, weight, y = 0.0, 0.0, 1.0, x
            while weights == 0 or y != x:
                total += weight * scale * r[y, choice[y]]
                weights += weight
                weight *= 1 - leak
                y = after[y, choice[y]]
            v[x] = total / (leak * weights)
        for i in range(length - 1, -1, -1):
            y = way[i]
            z = after[y, choice[y]]
            v[y] = v[z] + (scale * r[y, choice[y]] - leak * v[z])


@njit(cache=True, nogil=True)
def back_up(after: Integers, r: Array, gamma: float, failure: float, v: Array, q: Array) -> None:
    """Write the action values q[x, a] = r[x, a] + gamma E[v(x')] of values v."""
    S, A = r.shape
    for x in range(S):
        for a in range(A):
            q[x, a] = r[x, a] + gamma * (failure * v[x] + (1 - failure) * v[after[x, a]])
