"""L-MDP as the authors of PoLMDP ran it for a baseline: one bandit over the next actions."""

from dataclasses import dataclass
from time import perf_counter

import numpy as np

from policies.maze import ACTION_SETS, Maze
from policies.mdp import Array
from policies.searching import check_effort, in_chunks, search_world
from policies.solvers import goal_values, shortest_path_policy

GAMMA, BETA = 0.9, 0.5
ACTIONS = ACTION_SETS["udlr"]
MOST_MOVES = 502
"""A play of this baseline ends at the goal or after so many moves."""


@dataclass(frozen=True)
class Bandit:
    """Effort of the bandit: samples and depth of each real step, the time limit of a whole play.

    All else is the mode's own. Every step is planned from the uniform belief, without a tree.
    An action's return is the discounted sum of -sqrt(1 - b(g)^2), with actions of the goal's
    optimal policy after it; weights exp(.5 Q) of the belief are not normalised over actions. The
    index q + q sqrt(2 ln(sum n) / n) is the largest for what was tried the most, as q is
    negative, and the action taken is the one of the *least* q: both are wrong, and reported so.
    """

    simulations: int = 10_000
    depth: int = 10
    time_limit_s: float = np.inf

    def __post_init__(self) -> None:
        check_effort(self.simulations, self.depth, self.time_limit_s)


class BanditSearch:
    """The bandit for one goal of a maze, ready to run from any state."""

    actions = ACTIONS

    def __init__(self, maze: Maze, goal: str, search: Bandit) -> None:
        # Compiled code loads late: only who searches waits for it.
        from policies import lmdp_bandit_kernels as kernels

        self.kernels, self.search = kernels, search
        began = perf_counter()
        q = goal_values(maze, GAMMA, ACTIONS)
        # The best goal's weight is 1: a factor that all goals share is no evidence.
        likelihood = np.exp(BETA * (q - q.max(axis=0)))
        optimal = shortest_path_policy(maze, maze.goals[goal], ACTIONS)
        self.world = search_world(maze, goal, self.actions, likelihood, optimal)
        self.solve_time_s = perf_counter() - began
        self.horizon = kernels.Horizon(search.depth, GAMMA)
        self.arms = kernels.Arms(np.zeros(len(ACTIONS)), np.ones(len(ACTIONS), np.int64))
        # Compiled here, before the clock of a play's search runs.
        rng = np.random.default_rng(0)
        kernels.begin(self.arms, self.world, self.world.goal_state, self.horizon, rng)
        self._simulate(self.world.goal_state, 0, rng)

    @property
    def q(self) -> Array:
        """What each action was worth in the last run; the least is taken."""
        return self.arms.q

    def run(self, x: int, _belief: object, rng: np.random.Generator, until: float = np.inf) -> int:
        """Sample from a state, after once each action; forgets every belief.

        Ends early when perf_counter() passes `until`; returns the simulations run.
        """
        self.kernels.begin(self.arms, self.world, x, self.horizon, rng)
        return in_chunks(
            self.search.simulations,
            self.search.depth,
            until,
            lambda simulations: self._simulate(x, simulations, rng),
        )

    def _simulate(self, x: int, simulations: int, rng: np.random.Generator) -> None:
        self.kernels.simulate(self.arms, self.world, x, self.horizon, simulations, rng)
