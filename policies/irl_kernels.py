"""Compiled loops of gradient IRL in a maze; only `irl.py` calls them.

`after[x, a]` is the cell an action leads to when it does not fail, `r[x]` the state reward. A
failed action's self-loop is folded into a discount of `_kappa(gamma)`, and both linear systems
are swept to and fro from the last solution: in an ascent little changes from step to step, so
that is several times faster than factorising them anew.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from policies.maze import FAILURE
from policies.mdp import Array

Indices = NDArray[np.int64]

CONVERGED = 1e-13
"""Largest change of a last sweep, relative to the largest entry."""
TIE = 1e-9
"""Relative difference up to which two action values are a tie: well above what sweeps leave."""

FIRST_STEP, LAST_STEP = 0.5, 1e-3
"""Largest change of a cell's reward in one step of the ascent, of rewards between 0 and 1."""
TRIALS = 40
ENOUGH = 1e-3
"""A gain in log P by which the ascent ends."""


@njit(cache=True)
def ascend(
    goals: Indices, x: Indices, a: Indices, after: Indices, gamma: float, eta: float
) -> tuple[Array, float]:
    """The state reward that explains actions `a` in states `x` best, and log P under it.

    It is in [0, 1] at `goals` and 0 elsewhere. Projected gradient ascent from the same reward at
    all goals: a step that does not raise log P is halved, one that hardly does is the last.
    """
    S = len(after)
    r, v, y = np.zeros(S), np.zeros(S), np.zeros(S)
    r[goals] = 1 / len(goals)
    best = log_likelihood(r, x, a, after, gamma, eta, v)
    uphill = gradient(r, x, a, after, gamma, eta, v, y)[goals]
    step = FIRST_STEP
    for _ in range(TRIALS):
        steepest = np.abs(uphill).max()
        if steepest == 0 or step < LAST_STEP:
            break
        tried, v_tried = r.copy(), v.copy()
        tried[goals] = np.minimum(np.maximum(r[goals] + step / steepest * uphill, 0), 1)
        found = log_likelihood(tried, x, a, after, gamma, eta, v_tried)
        if found > best:
            gain = found - best
            r, v, best = tried, v_tried, found
            if gain < ENOUGH:
                break
            uphill = gradient(r, x, a, after, gamma, eta, v, y)[goals]
        else:
            step /= 2
    return r, best


@njit(cache=True)
def log_likelihood(
    r: Array, x: Indices, a: Indices, after: Indices, gamma: float, eta: float, v: Array
) -> float:
    """sum_t log P(a_t | x_t, r); moves `v` on to the optimal values."""
    optimal_values(r, after, gamma, v)
    total = 0.0
    for t in range(len(x)):
        weight = eta * _action_values(r, x[t], after, gamma, v)
        largest = weight.max()
        total += weight[a[t]] - largest - np.log(np.exp(weight - largest).sum())
    return total


@njit(cache=True)
def gradient(
    r: Array, x: Indices, a: Indices, after: Indices, gamma: float, eta: float, v: Array, y: Array
) -> Array:
    """Gradient of the log likelihood in r, through the policy that is greedy now.

    With dQ(x, a)/dr = e_x + gamma P(. | x, a) (I - gamma P_pi)^-1 it is eta gamma y, where y
    solves (I - gamma P_pi)^T y = w and w is what the actions seen lead to more than those
    expected. `v` holds the optimal values; `y` is moved on to the solution.
    """
    surplus = np.zeros(len(r))
    for t in range(len(x)):
        weight = eta * _action_values(r, x[t], after, gamma, v)
        expected = np.exp(weight - weight.max())
        expected /= expected.sum()
        surplus[after[x[t], a[t]]] += 1 - FAILURE
        for b in range(after.shape[1]):
            surplus[after[x[t], b]] -= (1 - FAILURE) * expected[b]
    occupancy(surplus, greedy(r, after, gamma, v), after, gamma, y)
    return eta * gamma * y


@njit(cache=True)
def optimal_values(r: Array, after: Indices, gamma: float, v: Array) -> None:
    """Value iteration in place, `v` being where it begins and what it finds."""
    S = len(v)
    kappa = _kappa(gamma)
    here = r / (1 - FAILURE * gamma)
    forward = True
    while True:
        change = 0.0
        for i in range(S):
            x = i if forward else S - 1 - i
            best = -np.inf
            for y in after[x]:
                best = max(best, r[x] / (1 - gamma) if y == x else here[x] + kappa * v[y])
            change = max(change, abs(best - v[x]))
            v[x] = best
        forward = not forward
        if change <= CONVERGED * np.abs(v).max():
            break


@njit(cache=True)
def occupancy(w: Array, policy: Array, after: Indices, gamma: float, y: Array) -> None:
    """Solve (I - gamma P_pi)^T y = w by sweeps, in place: w carried on as the policy goes."""
    S, A = after.shape
    forward = True
    while True:
        change = 0.0
        for i in range(S):
            x = i if forward else S - 1 - i
            stays, comes = 0.0, w[x]
            for a in range(A):
                z = after[x, a]
                if z == x:
                    stays += policy[x, a]
                else:  # up and down, left and right stand side by side: a ^ 1 leads back
                    comes += (1 - FAILURE) * gamma * policy[z, a ^ 1] * y[z]
            comes /= 1 - gamma * (FAILURE + (1 - FAILURE) * stays)
            change = max(change, abs(comes - y[x]))
            y[x] = comes
        forward = not forward
        if change <= CONVERGED * np.abs(y).max():
            break


@njit(cache=True)
def greedy(r: Array, after: Indices, gamma: float, v: Array) -> Array:
    """The greedy policy[x, a]; tied actions share uniformly."""
    policy = np.zeros(after.shape)
    for x in range(len(r)):
        q = _action_values(r, x, after, gamma, v)
        tied = q >= q.max() - TIE * abs(q.max())
        policy[x] = tied / tied.sum()
    return policy


@njit(cache=True)
def _action_values(r: Array, x: int, after: Indices, gamma: float, v: Array) -> Array:
    q: Array = r[x] + gamma * (FAILURE * v[x] + (1 - FAILURE) * v[after[x]])
    return q


@njit(cache=True)
def _kappa(gamma: float) -> float:
    return (1 - FAILURE) * gamma / (1 - FAILURE * gamma)
