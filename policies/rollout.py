"""Seeded rollouts: a policy acted out in the maze, failed actions as they fall."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from policies.errors import ModelError
from policies.maze import FAILURE, Action, Maze
from policies.mdp import Array


@dataclass(frozen=True, eq=False)
class Rollout:
    """Cells visited, `states` (T + 1,), and indices `a` of the actions taken, `actions` (T,)."""

    states: NDArray[np.int64]
    actions: NDArray[np.int64]
    arrived: bool

    @property
    def steps(self) -> int:
        """Number of steps T, failed actions counted."""
        return len(self.actions)


def draw_rollout(
    maze: Maze,
    policy: Array,
    start: int,
    goal: int | None,
    rng: np.random.Generator,
    actions: Sequence[Action],
    max_steps: int = 1000,
) -> Rollout:
    """Sample a ~ policy[x], x' ~ P until the goal is entered or `max_steps` have passed.

    Without a goal (None) the robot never stops early.
    """
    if not 0 <= start < maze.states:
        raise ModelError(f"expected a start from 0 to {maze.states - 1}, came {start}")
    # Plain uniforms and an inverse distribution: the same draws whatever numpy's `choice` does.
    upto = np.cumsum(policy, axis=1)
    upto /= upto[:, -1:]
    states, taken = [start], list[int]()
    while states[-1] != goal and len(taken) < max_steps:
        x = states[-1]
        a = int(np.searchsorted(upto[x], rng.random(), side="right"))
        fails = rng.random() < FAILURE
        taken.append(a)
        states.append(x if fails else int(maze.successors[x, actions[a]]))
    return Rollout(np.array(states), np.array(taken, int), states[-1] == goal)
