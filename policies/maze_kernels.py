"""Compiled loops over the cells of a maze; only functions that need them import this file.

`after[x, a]` is the cell that action a leads to when it does not fail. The first four actions
are up, down, left, right, so that `a ^ 1` leads back to where `a` came from.
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from policies.mdp import Array

Integers = NDArray[np.integer]

MOVES = 4
ROUNDING = 8 * np.finfo(float).eps
"""Relative gain up to which a value is as good as floating point makes it."""


@njit(cache=True, nogil=True)
def breadth_first(after: Integers, goal: int, d: Integers) -> int:
    """Write the fewest moves to the goal into `d`, -1 where no way leads; the cells reached."""
    queue = np.empty(len(d) + 1, np.int32)
    d[:] = -1
    d[goal] = 0
    queue[0] = goal
    first, last = 0, 1
    while first < last:
        x = queue[first]
        farther = d[x] + 1
        first += 1
        for a in range(MOVES):
            # Without a branch: whether a cell is new cannot be predicted, and guesses cost more.
            y = after[x, a]
            new = d[y] < 0
            d[y] = farther if new else d[y]
            queue[last] = y
            last += new
    return last


@njit(cache=True, nogil=True)
def gather(after: Integers, d: Integers, table: Array, into: Array) -> None:
    """Fill `into[n, x, a]` from `table[n, k, m]`: distance k; m = 0, 1, 2: nearer, equal, farther.

    A move changes the distance by at most 1, so an action has one of three values per distance.
    Where no way leads (k = -1) it is an entry of the last distance, finite as all are.
    """
    N, S, A = into.shape
    for n in range(N):
        of_goal, filled = d[n], into[n]
        for x in range(S):
            k = of_goal[x]
            values = table[n, k]
            for a in range(A):
                filled[x, a] = values[of_goal[after[x, a]] - k + 1]


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
def entering(after: Integers, r: Array, scale: float) -> Array:
    """What entering x from its neighbour on side a earns, times `scale`: (S, 4); -inf at walls."""
    S = len(r)
    c = np.empty((S, MOVES))
    for x in range(S):
        for a in range(MOVES):
            y = after[x, a]
            c[x, a] = scale * r[y, a ^ 1] if y != x else -math.inf
    return c


@njit(cache=True, nogil=True)
def start_values(after: Integers, r: Array, c: Array, scale: float, leak: float) -> Array:
    """The best of staying for ever and of going to and fro between two cells for ever, (S,)."""
    S, A = r.shape
    v = np.empty(S)
    for x in range(S):
        best = -math.inf
        for a in range(A):
            if after[x, a] == x:
                best = max(best, scale * r[x, a] / leak)
        for a in range(MOVES):
            y = after[x, a]
            if y != x:
                there_and_back = c[y, a ^ 1] + (1 - leak) * c[x, a]
                best = max(best, there_and_back / (leak * (2 - leak)))
        v[x] = best
    return v


@njit(cache=True, nogil=True)
def sources(after: Integers, c: Array, leak: float, v: Array, into: Integers) -> int:
    """Collect the cells that raise a neighbour's value and that no neighbour raises; their count.

    Whatever else is too low will be raised, and looked at, in consequence of these.
    """
    count = 0
    for x in range(len(v)):
        raises, raised = False, False
        for a in range(MOVES):
            y = after[x, a]
            if y != x:
                raised |= v[y] + (c[y, a ^ 1] - leak * v[y]) > v[x]
                raises |= v[x] + (c[x, a] - leak * v[x]) > v[y]
        if raises and not raised:
            into[count] = x
            count += 1
    return count


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
def best_first(step: Integers, c: Array, leak: float, v: Array, first: Integers, most: int) -> int:
    """Raise values to c[x, a] + (1 - leak) v(x), the highest x first; returns the cells taken up.

    `first` are the cells to begin with, in falling order; cells that are raised wait in a heap.
    `step[a]` is what action a adds to x where no wall stands. As a rule each cell is final when it
    is taken up (Dijkstra's label setting); where the order was wrong it is taken up again, `most`
    times in all. Whoever calls checks the residual.
    """
    S = len(v)
    heap, key = np.empty(S, np.int32), np.empty(S)
    place = np.full(S, -1, np.int32)
    size, begun, taken = 0, 0, 0
    while (size > 0 or begun < len(first)) and taken < most:
        taken += 1
        if size == 0 or (begun < len(first) and v[first[begun]] >= key[0]):
            x = first[begun]
            begun += 1
        else:
            x = heap[0]
            place[x] = -1
            size -= 1
            if size > 0:
                sink(heap, key, place, size)
        for a in range(MOVES):
            if c[x, a] == -math.inf:
                continue
            y = x + step[a]
            # Adding the difference keeps equal values exactly equal where all rewards are.
            raised = v[x] + (c[x, a] - leak * v[x])
            if raised > v[y]:
                v[y] = raised
                if place[y] < 0:
                    place[y] = size
                    size += 1
                rise(heap, key, place, place[y], y, raised)
    return taken


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
