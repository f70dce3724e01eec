"""Exact solvers for mazes of any size: legible rewards from a table, legible values best first.

The only chance in a maze is the failure that leaves the robot where it is. Waiting until a move
succeeds, discounted by gamma each time, is worth as much as a move that never fails with its
reward scaled by f = 1 / (1 - .15 gamma) and a discount kappa = .85 gamma f. What is left is a
graph without chance. `leak` is 1 - kappa = f (1 - gamma).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from policies.errors import ModelError
from policies.maze import FAILURE, Action, Maze
from policies.mdp import Array
from policies.priors import normalised
from policies.solvers import (
    cells_after,
    distances,
    gathered,
    nothing_in_closed_rooms,
    value_tables,
)

Variant = Literal["as_printed", "proper_posterior", "advantage"]

LARGEST_EXPONENT = 600.0
"""Up to this, exp(beta Q) keeps its full precision; beyond, posteriors stay in log space."""

MOST_TAKEN = 4
"""Cells are taken up once each as a rule; beyond so many times, exact evaluation is faster."""

ROUNDS = 100
"""Policy iteration ends after a few; rounding must not keep it going."""


@dataclass(frozen=True, eq=False)
class MazeSolution:
    """Optimal values `v[x]` and action values `q[x, a]` of a maze with rewards r[x, a].

    `bound` is the certified largest error of `v`, but for the rounding of `v` itself: the Bellman
    residual / (1 - kappa).
    """

    v: Array
    q: Array
    bound: float


def maze_rewards(
    maze: Maze,
    gamma: float,
    actions: Sequence[Action],
    beta: float,
    variant: Variant,
    prior: Array | None = None,
) -> tuple[Array, Array]:
    """Q*_n and r_leg of a maze, `q[n, x, a]` and `r_leg[n, x, a]` (paper eqs. 5-6).

    The same as `goal_values` and `legible_rewards`, from one table per distance; 0 in closed
    rooms. `prior[n]`: uniform if None.
    """
    from policies import maze_kernels as kernels

    d, after = distances(maze), cells_after(maze, actions)
    v, q = value_tables(maze, d, gamma, actions)
    log_w = beta * (q - (q.max() if variant == "as_printed" else v[:, :, None]))
    lowest, log_prior = log_w.min(), None
    if prior is not None:
        log_prior = np.log(normalised(prior, len(d)))[:, None, None]
        lowest += log_prior.min()
    in_log_space = lowest < -LARGEST_EXPONENT or log_w.max() > LARGEST_EXPONENT
    r_leg = gathered(after, d, log_w if in_log_space else np.exp(log_w))
    if variant == "proper_posterior":
        (kernels.log_over_actions if in_log_space else kernels.over_actions)(r_leg)
    if log_prior is not None:
        r_leg = r_leg + log_prior if in_log_space else r_leg * np.exp(log_prior)
    (kernels.exp_over_goals if in_log_space else kernels.over_goals)(r_leg)
    q = gathered(after, d, q)
    return nothing_in_closed_rooms(q, d), nothing_in_closed_rooms(r_leg, d)


def solve_maze(maze: Maze, r: Array, gamma: float, actions: Sequence[Action]) -> MazeSolution:
    """Optimal values of a maze with rewards `r[x, a]`, (S, A), and no end: exact, with its bound.

    Values spread best first from cells where the robot stays, or goes to and fro between two, as
    Dijkstra's algorithm spreads distances. Where longer cycles pay the residual shows it: there
    the greedy policy is evaluated exactly, as in policy iteration (Howard, 1960), and values
    spread again from what it is worth.
    """
    from policies import maze_kernels as kernels

    if not 0 <= gamma < 1:
        raise ModelError(f"expected gamma in [0, 1), came {gamma}")
    after = cells_after(maze, actions)
    if r.shape != after.shape or not np.isfinite(r).all():
        raise ModelError(f"expected finite rewards of shape {after.shape}, came {r.shape}")
    scale = 1 / (1 - FAILURE * gamma)
    leak = scale * (1 - gamma)
    c = kernels.entering(after, r, scale)
    v = kernels.start_values(after, r, c, scale, leak)
    best = np.empty(maze.states, np.int8)
    cells = np.empty(maze.states, np.int32)
    for _ in range(ROUNDS):
        first = cells[: kernels.sources(after, c, leak, v, cells)]
        first = first[np.argsort(-v[first])]
        kernels.best_first(_steps(maze), c, leak, v, first, MOST_TAKEN * maze.states)
        residual, more = kernels.improve(after, r, scale, leak, v, best)
        if not more:
            break
        kernels.evaluate_choice(after, r, scale, leak, best, v)
    q = np.empty_like(r)
    kernels.back_up(after, r, gamma, FAILURE, v, q)
    return MazeSolution(v, q, residual / leak)


def least_cost(maze: Maze, goal: int, cost: Array, actions: Sequence[Action]) -> Array:
    """Least expected undiscounted `cost[x, a]` >= 0 until the goal is entered, shape (S,).

    0 in closed rooms. Folding a failed action's self-loop leaves a graph with edges cost / .85,
    where taking up cells best first is Dijkstra's algorithm.
    """
    from policies import maze_kernels as kernels

    c = kernels.entering(cells_after(maze, actions), cost, -1 / (1 - FAILURE))
    v = np.full(maze.states, -np.inf)
    v[goal] = 0
    kernels.best_first(_steps(maze), c, 0.0, v, np.array([goal]), maze.states)
    least: Array = np.where(v > -np.inf, np.abs(v), 0)
    return least


def _steps(maze: Maze) -> NDArray[np.int64]:
    """What up, down, left and right add to a state where no wall stands."""
    return np.array([-maze.cols, maze.cols, -1, 1])
