"""What both searches of L-MDP share: their effort, their clock and what they know of a maze."""

from collections.abc import Callable, Sequence
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from policies.errors import ModelError
from policies.maze import FAILURE, Action, Maze
from policies.mdp import Array
from policies.solvers import cells_after

if TYPE_CHECKING:
    from policies.lmdp_kernels import World

STEPS_BETWEEN_LOOKS = 10_000
"""Simulated steps between two looks at the clock: about a millisecond."""


def check_effort(simulations: int, depth: int, time_limit_s: float) -> None:
    """ModelError where a search could not end, or not begin."""
    for name, value in (("simulations", simulations), ("depth", depth)):
        if value < 1:
            raise ModelError(f"expected {name} of at least 1, came {value}")
    if not time_limit_s > 0:
        raise ModelError(f"expected a time limit above 0 s, came {time_limit_s}")


def in_chunks(simulations: int, depth: int, until: float, simulate: Callable[[int], None]) -> int:
    """Simulate until all is done or perf_counter() passes `until`; how many were simulated."""
    done, chunk = 0, max(1, STEPS_BETWEEN_LOOKS // depth)
    while done < simulations and perf_counter() < until:
        chunk = min(chunk, simulations - done)
        simulate(chunk)
        done += chunk
    return done


def search_world(
    maze: Maze, goal: str, actions: Sequence[Action], likelihood: Array, policy: Array
) -> "World":
    """What a compiled search knows, from `likelihood[n, x, a]` and its rollouts' `policy[x, a]`."""
    from policies.lmdp_kernels import World

    upto = policy.cumsum(axis=1)
    return World(
        cells_after(maze, actions),
        np.ascontiguousarray(likelihood.transpose(1, 2, 0)),
        upto / upto[:, -1:],
        maze.goal_index(goal),
        maze.goals[goal],
        FAILURE,
    )
