"""Exact solvers for mazes of any size: legible rewards from a table, legible values best first.

The only chance in a maze is the failure that leaves the robot where it is. Waiting until a move
succeeds, discounted by gamma each time, is worth as much as a move that never fails with its
reward scaled by f = 1 / (1 - .15 gamma) and a discount kappa = .85 gamma f. What is left is a
graph without chance. `leak` is 1 - kappa = f (1 - gamma).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from policies.errors import ModelError
from policies.maze import FAILURE, Action, Maze
from policies.mdp import Array
from policies.priors import normalised
from policies.solvers import check_discount, distances, goal_states

Variant = Literal["as_printed", "proper_posterior", "advantage"]


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
    from policies.maze_kernels import fill_rewards

    check_discount(gamma)
    less_v, by_action = variant != "as_printed", variant == "proper_posterior"
    log_prior = np.log(normalised(prior, len(maze.goals)))
    # One block of memory: two are handed back to the system and fetched anew every time.
    q_and_r = np.empty((2, len(maze.goals), maze.states, len(actions)))
    reached = fill_rewards(
        maze.successors,
        goal_states(maze),
        gamma,
        FAILURE,
        beta,
        less_v,
        by_action,
        log_prior - log_prior[0],
        q_and_r,
    )
    if reached < maze.states:
        distances(maze)  # refuses goals without a way between them
    return q_and_r[0], q_and_r[1]


def solve_maze(maze: Maze, r: Array, gamma: float, actions: Sequence[Action]) -> MazeSolution:
    """Optimal values of a maze with rewards `r[x, a]`, (S, A), and no end: exact, with its bound.

    ModelError when a reward is not finite or gamma is outside [0, 1).
    """
    from policies.value_kernels import optimise

    check_discount(gamma)
    v, q = np.empty(maze.states), np.empty((maze.states, len(actions)))
    bound = optimise(maze.successors, r, gamma, FAILURE, v, q) if r.shape == q.shape else math.nan
    if math.isnan(bound):
        raise ModelError(f"expected finite rewards of shape {q.shape}, came {r.shape}")
    return MazeSolution(v, q, bound)


def least_cost(maze: Maze, goal: int, cost: Array) -> Array:
    """Least expected undiscounted `cost[x, a]` >= 0 until the goal is entered, shape (S,).

    0 in closed rooms. Folding a failed action's self-loop leaves a graph with edges cost / .85,
    where taking up cells best first is Dijkstra's algorithm.
    """
    from policies import value_kernels

    least = np.empty(maze.states)
    value_kernels.least_cost(maze.successors, cost, FAILURE, goal, least)
    least[least == np.inf] = 0
    return least
