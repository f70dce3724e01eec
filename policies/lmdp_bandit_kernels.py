"""Compiled bandit of mode `as_reported`; only lmdp_bandit.py imports this, late."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from policies.lmdp_kernels import World, follow, moved_to
from policies.mdp import Array


class Horizon(NamedTuple):
    """A return sums at most `depth` rewards, discounted by `gamma`."""

    depth: int
    gamma: float


class Arms(NamedTuple):
    """One arm an action: `q[a]`, the return's mean with a first 0 counted in, and counts `n[a]`."""

    q: Array
    n: NDArray[np.int64]


@njit(cache=True)
def begin(arms: Arms, world: World, x: int, horizon: Horizon, rng: np.random.Generator) -> None:
    """Forget all, then sample every action once, in order."""
    arms.q[:] = 0.0
    arms.n[:] = 1
    for a in range(len(arms.q)):
        sample(arms, world, x, a, horizon, rng)


@njit(cache=True)
def simulate(
    arms: Arms, world: World, x: int, horizon: Horizon, simulations: int, rng: np.random.Generator
) -> None:
    """Sample so many actions, each the one of the largest index."""
    for _ in range(simulations):
        sample(arms, world, x, largest_index(arms), horizon, rng)


@njit(cache=True)
def largest_index(arms: Arms) -> int:
    """First of the largest q + q sqrt(2 ln(sum n) / n), as q < 0 smaller for what is less tried."""
    certain = 2 * np.log(arms.n.sum())
    best, largest = 0, -np.inf
    for a in range(len(arms.q)):
        index = arms.q[a] + arms.q[a] * np.sqrt(certain / arms.n[a])
        if index > largest:
            best, largest = a, index
    return best


@njit(cache=True)
def sample(
    arms: Arms, world: World, x: int, a: int, horizon: Horizon, rng: np.random.Generator
) -> None:
    """Add one return of an action to its arm."""
    arms.n[a] += 1
    arms.q[a] += (discounted_return(world, x, a, horizon, rng) - arms.q[a]) / arms.n[a]


@njit(cache=True)
def discounted_return(
    world: World, x: int, a: int, horizon: Horizon, rng: np.random.Generator
) -> float:
    """Return of an action and up to depth - 1 more of the goal's optimal policy.

    The belief begins uniform; an action taken at the goal is the last that counts.
    """
    belief = np.full(world.likelihood.shape[2], 1 / world.likelihood.shape[2])
    total, weight = 0.0, 1.0
    for k in range(horizon.depth):
        if k:
            u, a = rng.random(), 0
            while u >= world.upto[x, a]:
                a += 1
        follow(belief, world.likelihood[x, a])
        total -= weight * np.sqrt(max(0.0, 1 - belief[world.goal] ** 2))
        if x == world.goal_state:
            break
        weight *= horizon.gamma
        x = moved_to(world, x, a, rng)
    return total
