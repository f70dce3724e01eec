"""The frameworks compared: each plans and plays one pair of start and goal, on the clock."""

from dataclasses import dataclass, replace
from functools import cache
from time import perf_counter

import numpy as np

from policies.experiments.comparison import Comparison
from policies.experiments.worlds import Pair
from policies.lmdp import play_lmdp
from policies.maze import ACTION_SETS, Maze, random_maze
from policies.mdp import Array
from policies.measures import measure_legibility
from policies.observer import action_beliefs
from policies.polmdp import plan_legible
from policies.rollout import Rollout, draw_rollout
from policies.solvers import distances, goal_values, shortest_path_policy

Measures = tuple[float, float, float]
"""The PoLMDP measure as discounted sum and as mean per step, and the L-MDP measure."""


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
    framework: str, maze: Maze, pair: Pair, comparison: Comparison, rng: np.random.Generator
) -> Played:
    """Plan for a pair with one of the comparison's frameworks and play it once."""
    if framework == "lmdp":
        return play_search(maze, pair, comparison, rng)
    actions = ACTION_SETS[comparison.actions]
    began = perf_counter()
    if framework == "optimal":
        policy = shortest_path_policy(maze, maze.goals[pair.goal], actions)
        goal_solves_s, plan_s = perf_counter() - began, 0.0
    else:
        goal_values(maze, comparison.gamma, actions)
        goal_solves_s = perf_counter() - began
        # Planning solves the goals' MDPs itself; what that takes is told apart, not twice.
        began = perf_counter()
        policy = plan_legible(maze, pair.goal, comparison.polmdps[framework]).policy_legible
        plan_s = max(0.0, perf_counter() - began - goal_solves_s)
    goal, allowed = maze.goals[pair.goal], _allowed(maze, pair, comparison)
    began = perf_counter()
    rollout = draw_rollout(maze, policy, pair.start, goal, rng, actions, allowed)
    return Played(rollout, goal_solves_s, plan_s + perf_counter() - began)


def play_search(maze: Maze, pair: Pair, comparison: Comparison, rng: np.random.Generator) -> Played:
    """Let L-MDP plan and play a pair."""
    allowed = _allowed(maze, pair, comparison)
    played = play_lmdp(maze, pair.start, pair.goal, rng, comparison.search, allowed)
    return Played(
        played.rollout,
        goal_solves_s=played.solve_time_s,
        planning_s=played.search_time_s,
        timed_out=played.ended == "time limit",
    )


def measure(
    rollout: Rollout, n: int, maze: Maze, comparison: Comparison, q: Array, r_leg: Array
) -> Measures:
    """Measure a play towards goal n, by `q[n, x, a]` and `r_leg[n, x, a]`."""
    actions, beta = ACTION_SETS[comparison.actions], comparison.observer_beta
    beliefs = action_beliefs(maze, q, rollout.states, rollout.actions, actions, beta)
    seen = measure_legibility(
        rollout, n, r_leg, beliefs, comparison.gamma, comparison.belief_distance
    )
    return seen.polmdp, seen.polmdp_per_step, seen.lmdp


@cache
def warm_up(comparison: Comparison) -> None:
    """Once a process: what is imported, compiled or read from a cache is not to be timed."""
    maze = random_maze(3, 3, 2, np.random.default_rng(0))
    pair = Pair(0, int(maze.goals["B"]), "A")
    quick = replace(comparison, simulations=1)
    for framework in comparison.frameworks:
        play(framework, maze, pair, quick, np.random.default_rng(0))


def _allowed(maze: Maze, pair: Pair, comparison: Comparison) -> int:
    return comparison.moves_allowed(distances(maze)[maze.goal_index(pair.goal), pair.start])
