"""Compiled tree search over (state, belief); loaded late, by who searches."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from policies.mdp import Array

TV, EUCLID, KL = range(3)
LEAST_BELIEF = np.finfo(np.float64).tiny
NONE = -1


class World(NamedTuple):
    """What the search knows of maze, goal and observer.

    `after[x, a]` is where an action leads, `likelihood[x, a, n]` the observer's of a goal,
    `upto[x, a]` the rollout policy's cumulative probabilities, `goal` the index n.
    """

    after: NDArray[np.int64]
    likelihood: Array
    upto: Array
    goal: int
    goal_state: int
    failure: float


class Costs(NamedTuple):
    """A stage costs the belief's distance plus `task`, nothing at the goal; never discounted."""

    distance: int
    task: float


class Tree(NamedTuple):
    """Decision nodes i, 0 the root: `state[i]`, `belief[i, n]`, `cost[i]` of being there.

    Their chance nodes (i, a): `visits[i, a]`, `q[i, a]` the mean cost of what followed, and
    `child[i, a, moved]`, the decision node after the action failed or moved, or NONE.
    `size[0]` counts the nodes in use.
    """

    state: NDArray[np.int64]
    belief: Array
    cost: Array
    visits: NDArray[np.int64]
    q: Array
    child: NDArray[np.int64]
    size: NDArray[np.int64]


def empty_tree(nodes: int, A: int, N: int) -> Tree:
    """Room for a tree of so many decision nodes."""
    return Tree(
        np.empty(nodes, np.int64),
        np.empty((nodes, N)),
        np.empty(nodes),
        np.empty((nodes, A), np.int64),
        np.empty((nodes, A)),
        np.empty((nodes, A, 2), np.int64),
        np.zeros(1, np.int64),
    )


@njit(cache=True)
def plant(tree: Tree, world: World, costs: Costs, x: int, belief: Array) -> None:
    """Begin a tree anew at a state and belief."""
    tree.size[0] = 0
    tree.belief[0] = belief
    add_node(tree, world, costs, x)


@njit(cache=True)
def simulate(
    tree: Tree,
    world: World,
    costs: Costs,
    depth: int,
    exploration: float,
    simulations: int,
    rng: np.random.Generator,
) -> None:
    """Run UCT simulations from the root.

    Each descends to a node not seen before, values it by a rollout and backs the cost of the
    `depth` stages up (Kocsis & Szepesvari 2006). The cost of being at the root is left out of `q`.
    """
    nodes = np.empty(depth, np.int64)
    taken = np.empty(depth, np.int64)
    cost = np.empty(depth)
    belief = np.empty(tree.belief.shape[1])
    for _ in range(simulations):
        i, h, after = 0, 0, 0.0
        while True:
            a = least_bound(tree, i, exploration)
            y = moved_to(world, tree.state[i], a, rng)
            moved = int(y != tree.state[i])
            nodes[h], taken[h] = i, a
            j = tree.child[i, a, moved]
            new = j == NONE
            if new:
                j = tree.child[i, a, moved] = tree.size[0]
                tree.belief[j] = tree.belief[i]
                follow(tree.belief[j], world.likelihood[tree.state[i], a])
                add_node(tree, world, costs, y)
            cost[h] = tree.cost[j]
            h += 1
            if y == world.goal_state or h == depth:
                break
            if new:
                belief[:] = tree.belief[j]
                after = rollout_cost(world, costs, y, belief, depth - h, rng)
                break
            i = j
        for k in range(h - 1, -1, -1):
            after += cost[k]
            i, a = nodes[k], taken[k]
            tree.visits[i, a] += 1
            tree.q[i, a] += (after - tree.q[i, a]) / tree.visits[i, a]


@njit(cache=True)
def add_node(tree: Tree, world: World, costs: Costs, x: int) -> None:
    """Complete the next node, whose belief is already there."""
    i = tree.size[0]
    tree.state[i] = x
    tree.cost[i] = stage_cost(world, costs, x, tree.belief[i])
    tree.visits[i] = 0
    tree.q[i] = 0.0
    tree.child[i] = NONE
    tree.size[0] = i + 1


@njit(cache=True)
def least_bound(tree: Tree, i: int, exploration: float) -> int:
    """UCB1 on costs: an untried action, else the least q - c sqrt(2 ln N / n)."""
    total = 0
    for a in range(tree.visits.shape[1]):
        if tree.visits[i, a] == 0:
            return a
        total += tree.visits[i, a]
    spread = exploration * np.sqrt(2 * np.log(total))
    best, least = 0, np.inf
    for a in range(tree.visits.shape[1]):
        bound = tree.q[i, a] - spread / np.sqrt(tree.visits[i, a])
        if bound < least:
            best, least = a, bound
    return best


@njit(cache=True)
def rollout_cost(
    world: World, costs: Costs, x: int, belief: Array, steps: int, rng: np.random.Generator
) -> float:
    """Cost of acting on from x by the rollout policy; `belief` is used up."""
    total = 0.0
    for _ in range(steps):
        u, a = rng.random(), 0
        while u >= world.upto[x, a]:
            a += 1
        follow(belief, world.likelihood[x, a])
        x = moved_to(world, x, a, rng)
        if x == world.goal_state:
            break
        total += stage_cost(world, costs, x, belief)
    return total


@njit(cache=True)
def moved_to(world: World, x: int, a: int, rng: np.random.Generator) -> int:
    """Sample x' after an action, which fails or leads on."""
    y = world.after[x, a]
    return x if y == x or rng.random() < world.failure else y


@njit(cache=True)
def follow(belief: Array, likelihood: Array) -> None:
    """Bayes' rule in place, as observer.updated; where all evidence is 0 the belief stays."""
    total = 0.0
    for n in range(len(belief)):
        total += belief[n] * likelihood[n]
    if total > 0:
        for n in range(len(belief)):
            belief[n] *= likelihood[n] / total


@njit(cache=True)
def stage_cost(world: World, costs: Costs, x: int, belief: Array) -> float:
    """Distance of the belief, as observer.belief_distance, plus the task's cost; 0 at the goal.

    A belief of 0 counts as the least normal float: an infinite KL would leave nothing to compare.
    """
    if x == world.goal_state:
        return 0.0
    certain = belief[world.goal]
    if costs.distance == TV:
        far = 1 - certain
    elif costs.distance == EUCLID:
        squares = (1 - certain) ** 2
        for n in range(len(belief)):
            if n != world.goal:
                squares += belief[n] ** 2
        far = np.sqrt(squares)
    else:
        far = -np.log(max(certain, LEAST_BELIEF))
    cost: float = far + costs.task
    return cost
