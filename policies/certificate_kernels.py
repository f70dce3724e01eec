"""Compiled passes over the moves of a policy; only `policies.certificate` imports this file.

`after[x, a]` is the cell that action a leads to when it does not fail; what the policy does at
the goal does not matter.
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from policies.mdp import Array

Integers = NDArray[np.integer]

ASSIGNED = np.iinfo(np.int32).max


@njit(cache=True, nogil=True)
def components(after: Integers, policy: Array, goal: int, order: Integers, ends: Integers) -> int:
    """Write states into `order` by component, each component after all that it leads to.

    A component is a set of states that lead to one another, mostly a single one (Tarjan, 1972).
    Component k is `order[ends[k] : ends[k + 1]]`; returns their number.
    """
    S, A = policy.shape
    met, low = np.zeros(S, np.int32), np.zeros(S, np.int32)
    tried = np.zeros(S, np.int8)
    way, unassigned = np.empty(S, np.int32), np.empty(S, np.int32)
    clock, assigned, count = 0, 0, 0
    ends[0] = 0
    for start in range(S):
        if met[start] > 0:
            continue
        depth, waiting = 0, 0
        way[0] = start
        while depth >= 0:
            x = way[depth]
            if met[x] == 0:
                clock += 1
                met[x] = low[x] = clock
                unassigned[waiting] = x
                waiting += 1
            deeper = False
            while tried[x] < A and not deeper and x != goal:
                a = tried[x]
                y = after[x, a]
                if policy[x, a] > 0 and met[y] == 0:
                    depth += 1
                    way[depth] = y
                    deeper = True
                else:
                    if policy[x, a] > 0:
                        low[x] = min(low[x], low[y])
                    tried[x] += 1
            if deeper:
                continue
            if low[x] == met[x]:
                y = -1
                while y != x:
                    waiting -= 1
                    y = unassigned[waiting]
                    low[y] = ASSIGNED
                    order[assigned] = y
                    assigned += 1
                count += 1
                ends[count] = assigned
            depth -= 1
    return count


@njit(cache=True, nogil=True)
def expect_steps(
    after: Integers,
    policy: Array,
    goal: int,
    success: float,
    order: Integers,
    ends: Integers,
    first: int,
    steps: Array,
) -> int:
    """Write the expected steps to the goal, component by component from `first` on.

    inf where the goal may never be reached. Stops at a component of several states and returns
    its number, or how many there are.
    """
    for k in range(first, len(ends) - 1):
        x = order[ends[k]]
        if ends[k + 1] - ends[k] > 1:
            return k
        moving, onwards = 0.0, 0.0
        for a in range(policy.shape[1]):
            y = after[x, a]
            if policy[x, a] > 0 and y != x:
                moving += policy[x, a]
                onwards += policy[x, a] * steps[y]
        if x == goal:
            steps[x] = 0.0
        elif moving > 0:
            steps[x] = (1 / success + onwards) / moving
        else:
            steps[x] = math.inf
    return len(ends) - 1
