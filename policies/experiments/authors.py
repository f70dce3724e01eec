"""The preset `authors`: what the paper's authors did and no option says (their published runs)."""

from time import perf_counter

import numpy as np
from scipy.special import softmax

from policies.experiments.comparison import Comparison
from policies.experiments.frameworks import Measures, Played, play_search
from policies.experiments.worlds import Pair
from policies.lmdp_bandit import ACTIONS, BETA, GAMMA, MOST_MOVES, Bandit, BanditSearch
from policies.maze import FAILURE, Maze
from policies.maze_solver import solve_maze
from policies.mdp import Array, uniform_over
from policies.polmdp import legible_rewards
from policies.rollout import Rollout
from policies.solvers import cells_after, goal_values

SEED = 2021
"""Every play has a generator of its own from this seed."""

TIE = 1e-10
"""Difference up to which two action values tie."""

LAST_SEARCH = Bandit(simulations=1000, depth=20)
"""L-MDP draws the action where its play ended by one more search."""


def play_and_measure(
    framework: str, maze: Maze, pair: Pair, comparison: Comparison, q: Array, r_leg: Array
) -> tuple[Played, Measures]:
    """Plan for a pair, play it once and draw one more action where that ended; measure them all.

    By `q[n, x, a]` and `r_leg[n, x, a]` of four moves.
    """
    rng = np.random.default_rng(SEED)
    n = maze.goal_index(pair.goal)
    if framework == "lmdp":
        played = play_search(maze, pair, comparison, rng)
        last = search_once_more(maze, pair.goal, int(played.rollout.states[-1]), rng)
    else:
        began = perf_counter()
        values = goal_values(maze, GAMMA, ACTIONS)
        goal_solves_s = perf_counter() - began
        if framework == "optimal":
            policy = policy_of(values[n])
        else:
            rewards = legible_rewards(values, BETA)[n]
            policy = policy_of(solve_maze(maze, rewards, GAMMA, ACTIONS).q)
        rollout, last = roll_out(maze, policy, pair, rng)
        played = Played(rollout, goal_solves_s, perf_counter() - began - goal_solves_s)
    return played, measure(played.rollout, last, n, q, r_leg)


def search_once_more(maze: Maze, goal: str, x: int, rng: np.random.Generator) -> int:
    """The action that L-MDP takes where its play ended."""
    searching = BanditSearch(maze, goal, LAST_SEARCH)
    searching.run(x, None, rng)
    return int(searching.q.argmin())


def policy_of(q: Array) -> Array:
    """Probability shared uniformly over the actions that tie, (S, A)."""
    return uniform_over(q >= q.max(axis=1, keepdims=True) - TIE)


def roll_out(
    maze: Maze, policy: Array, pair: Pair, rng: np.random.Generator
) -> tuple[Rollout, int]:
    """Play a policy (S, A) to the goal or for 502 moves; the rollout and the action drawn then.

    a is drawn over the actions, x' over all states, each with `choice`.
    """
    goal, after = maze.goals[pair.goal], cells_after(maze, ACTIONS)
    states, taken = [pair.start], list[int]()
    while True:
        x = states[-1]
        a = int(rng.choice(len(ACTIONS), p=policy[x]))
        if x == goal or len(taken) == MOST_MOVES:
            return Rollout(np.array(states), np.array(taken, int), x == goal), a
        P = np.zeros(maze.states)
        P[x] += FAILURE
        P[after[x, a]] += 1 - FAILURE
        taken.append(a)
        states.append(int(rng.choice(maze.states, p=P)))


def measure(rollout: Rollout, last: int, n: int, q: Array, r_leg: Array) -> Measures:
    """Sums over t = 0..T of .9^t r_leg(x_t, a_t) and .9^t sqrt(1 - b_{t+1}(g)^2); a_T is `last`.

    b_{t+1}, after a_t, from a uniform b_0 by weights exp(.5 Q) not normalised over actions; that
    the last action may fail or lead on tells nothing of a goal. The per step mean is over T + 1.
    """
    taken = np.append(rollout.actions, last)
    discount = GAMMA ** np.arange(len(taken))
    r = r_leg[n, rollout.states, taken]
    beliefs = softmax(BETA * q[:, rollout.states, taken].cumsum(axis=1), axis=0)
    # Rounding may carry a belief past 1.
    far = np.sqrt(np.maximum(0, 1 - beliefs[n] ** 2))
    return float(discount @ r), float(r.mean()), float(discount @ far)
