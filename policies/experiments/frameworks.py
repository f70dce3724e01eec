"""The three frameworks compared: each plans and plays one pair of start and goal, on the clock."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from time import perf_counter

import numpy as np

from policies.experiments.worlds import Pair
from policies.lmdp import Search, play_lmdp
from policies.maze import ACTION_SETS, Maze, random_maze
from policies.mdp import Array
from policies.measures import steps_allowed
from policies.polmdp import Parameters, plan_legible
from policies.rollout import Rollout, draw_rollout
from policies.solvers import distances, goal_values, shortest_path_policy

PAPER = Parameters(actions="udlr")
"""The preset `paper` with the four moves of the paper's comparison."""
ACTIONS = ACTION_SETS[PAPER.actions]


@dataclass(frozen=True, eq=False)
class Played:
    """What a framework made of a pair.

    Times by the wall's clock: `goal_solves_s` for the MDPs of the goals, `planning_s` for all
    after them, one play included (what the paper timed).
    """

    rollout: Rollout
    goal_solves_s: float
    planning_s: float
    timed_out: bool = False


def play(
    framework: str, maze: Maze, pair: Pair, search: Search, rng: np.random.Generator
) -> Played:
    """Plan for a pair with one of FRAMEWORKS and play it once, at most 4 x distance / .85 steps.

    `search` holds L-MDP's parameters, its time limit among them.
    """
    _warm_up(replace(search, simulations=1))
    return _PLAYS[framework](maze, pair, search, rng)


def _play_polmdp(maze: Maze, pair: Pair, _search: Search, rng: np.random.Generator) -> Played:
    began = perf_counter()
    goal_values(maze, PAPER.gamma, ACTIONS)
    goal_solves_s = perf_counter() - began
    # Planning solves the goals' MDPs itself; what that takes is told apart, not twice.
    began = perf_counter()
    plan = plan_legible(maze, pair.goal, PAPER)
    plan_s = perf_counter() - began
    rollout, play_s = _roll_out(maze, pair, plan.policy_legible, rng)
    return Played(rollout, goal_solves_s, max(0.0, plan_s - goal_solves_s) + play_s)


def _play_optimal(maze: Maze, pair: Pair, _search: Search, rng: np.random.Generator) -> Played:
    began = perf_counter()
    policy = shortest_path_policy(maze, maze.goals[pair.goal], ACTIONS)
    solve_s = perf_counter() - began
    rollout, play_s = _roll_out(maze, pair, policy, rng)
    return Played(rollout, solve_s, play_s)


def _play_lmdp(maze: Maze, pair: Pair, search: Search, rng: np.random.Generator) -> Played:
    played = play_lmdp(maze, pair.start, pair.goal, rng, search)
    return Played(
        played.rollout,
        goal_solves_s=played.solve_time_s,
        planning_s=played.search_time_s,
        timed_out=played.ended == "time limit",
    )


def _roll_out(
    maze: Maze, pair: Pair, policy: Array, rng: np.random.Generator
) -> tuple[Rollout, float]:
    """One play of a policy (S, A), and the seconds it took."""
    goal = maze.goals[pair.goal]
    allowed = steps_allowed(distances(maze)[maze.goal_index(pair.goal), pair.start])
    began = perf_counter()
    rollout = draw_rollout(maze, policy, pair.start, goal, rng, ACTIONS, allowed)
    return rollout, perf_counter() - began


_PLAYS: Mapping[str, Callable[[Maze, Pair, Search, np.random.Generator], Played]] = {
    "polmdp": _play_polmdp,
    "lmdp": _play_lmdp,
    "optimal": _play_optimal,
}
FRAMEWORKS = tuple(_PLAYS)


@cache
def _warm_up(search: Search) -> None:
    """Once a process: what is imported, compiled or read from a cache is not to be timed."""
    maze = random_maze(3, 3, 2, np.random.default_rng(0))
    pair = Pair(0, int(maze.goals["B"]), "A")
    for play_once in _PLAYS.values():
        play_once(maze, pair, search, np.random.default_rng(0))
