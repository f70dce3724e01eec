"""L-MDP, the baseline: plays made legible by searching over what an observer believes."""

from collections.abc import Mapping
from dataclasses import dataclass
from time import perf_counter
from types import MappingProxyType
from typing import Literal, get_args

import numpy as np
from scipy.special import softmax

from policies.errors import ModelError
from policies.lmdp_bandit import MOST_MOVES, Bandit, BanditSearch
from policies.maze import ACTION_SETS, FAILURE, Maze
from policies.mdp import Array
from policies.measures import steps_allowed
from policies.observer import OBSERVER_BETA, Distance, updated
from policies.polmdp import ActionSet
from policies.rollout import Rollout
from policies.searching import check_effort, in_chunks, search_world
from policies.solvers import distances, goal_values, shortest_path_policy

Rollouts = Literal["optimal", "random"]
Ending = Literal["arrived", "step limit", "time limit"]


@dataclass(frozen=True)
class Search:
    """Parameters of the search; the defaults are Miura, Cohen & Zilberstein (RO-MAN 2021).

    distance: of a stage's belief, one of belief_distance. task: added to it for each step.
    simulations, depth: of each real step. exploration: UCB1's c. rollouts: the policy that values
    a new leaf. gamma: discount of the goals' MDPs; the search itself is bounded by its depth
    alone (discounted it loiters). beta: the observer's. time_limit_s: of a whole play.
    """

    distance: Distance = "tv"
    task: float = 0.1
    simulations: int = 10_000
    depth: int = 30
    exploration: float = 1.0
    rollouts: Rollouts = "optimal"
    gamma: float = 0.9
    beta: float = OBSERVER_BETA
    actions: ActionSet = "udlrn"
    time_limit_s: float = np.inf

    def __post_init__(self) -> None:
        check_effort(self.simulations, self.depth, self.time_limit_s)
        for name in ("task", "exploration"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0):
                raise ModelError(f"expected a finite {name} of at least 0, came {value}")
        if not (np.isfinite(self.beta) and self.beta > 0):
            raise ModelError(f"expected a finite beta above 0, came {self.beta}")
        if not 0 <= self.gamma < 1:
            raise ModelError(f"expected gamma in [0, 1), came {self.gamma}")
        for name, allowed in (
            ("distance", get_args(Distance)),
            ("rollouts", get_args(Rollouts)),
            ("actions", get_args(ActionSet)),
        ):
            value = getattr(self, name)
            if value not in allowed:
                raise ModelError(f"expected {name} in {', '.join(allowed)}; came {value!r}")


SEARCHES: Mapping[str, Search | Bandit] = MappingProxyType(
    {"miura": Search(), "as_reported": Bandit()}
)
"""Both modes: the algorithm as published, and as the authors of PoLMDP ran it as a baseline."""


@dataclass(frozen=True, eq=False)
class Play:
    """One play of L-MDP from a start towards a goal.

    `beliefs[t, n]` of the observer who sees the actions; `ended` says why; `simulations` run in
    all; `solve_time_s` for the goals' MDPs and the observer, `search_time_s` for the search.
    """

    rollout: Rollout
    beliefs: Array
    ended: Ending
    simulations: int
    solve_time_s: float
    search_time_s: float


class TreeSearch:
    """The tree search for one goal of a maze, ready to run from any state and belief."""

    def __init__(self, maze: Maze, goal: str, search: Search) -> None:
        # Compiled code loads late: only who searches waits for it.
        from policies import lmdp_kernels as kernels

        self.kernels, self.search, self.actions = kernels, search, ACTION_SETS[search.actions]
        began = perf_counter()
        q = goal_values(maze, search.gamma, self.actions)
        if search.rollouts == "optimal":
            policy = shortest_path_policy(maze, maze.goals[goal], self.actions)
        else:
            policy = np.full(q.shape[1:], 1 / len(self.actions))
        likelihood = softmax(search.beta * q, axis=2)
        self.world = search_world(maze, goal, self.actions, likelihood, policy)
        self.solve_time_s = perf_counter() - began
        N, _, A = q.shape
        self.costs = kernels.Costs(get_args(Distance).index(search.distance), search.task)
        self.tree = kernels.empty_tree(search.simulations + 1, A, N)
        # Compiled here, before the clock of a play's search runs.
        rng = np.random.default_rng(0)
        self.run(self.world.goal_state, np.full(N, 1 / N), rng, until=-np.inf)
        self._simulate(0, rng)

    @property
    def q(self) -> Array:
        """The cost of each action at the root of the last run; the least is taken."""
        q: Array = self.tree.q[0]
        return q

    def run(self, x: int, belief: Array, rng: np.random.Generator, until: float = np.inf) -> int:
        """Search from a state and belief (N,).

        Ends early when perf_counter() passes `until`; returns the simulations run.
        """
        self.kernels.plant(self.tree, self.world, self.costs, x, belief)
        return in_chunks(
            self.search.simulations,
            self.search.depth,
            until,
            lambda simulations: self._simulate(simulations, rng),
        )

    def _simulate(self, simulations: int, rng: np.random.Generator) -> None:
        how = self.search
        self.kernels.simulate(
            self.tree, self.world, self.costs, how.depth, how.exploration, simulations, rng
        )


def play_lmdp(
    maze: Maze,
    start: int,
    goal: str,
    rng: np.random.Generator,
    search: Search | Bandit = SEARCHES["miura"],
    most_moves: int | None = None,
) -> Play:
    """Plan and act step by step until the goal, `most_moves` or the time limit.

    `most_moves` is 4 x distance / .85 if not said, for a Bandit 502. The time limit covers
    solving and searching, not the compiling of the search on first use; the same seed gives the
    same play wherever the limit is not reached.
    ModelError for a start outside the maze or in a closed room, MazeError for an unknown goal.
    """
    n = maze.goal_index(goal)
    if not 0 <= start < maze.states:
        raise ModelError(f"expected a start from 0 to {maze.states - 1}, came {start}")
    distance = float(distances(maze)[n, start])
    if distance < 0:
        raise ModelError(f"expected a start with a way to the goals, came {start}")
    searching: TreeSearch | BanditSearch
    if isinstance(search, Bandit):
        searching, allowed = BanditSearch(maze, goal, search), MOST_MOVES
    else:
        searching, allowed = TreeSearch(maze, goal, search), steps_allowed(distance)
    allowed = most_moves or allowed
    world = searching.world
    began = perf_counter()
    until = began + search.time_limit_s - searching.solve_time_s
    N = len(maze.goals)
    states, taken, beliefs, simulations = [start], list[int](), [np.full(N, 1 / N)], 0
    while states[-1] != world.goal_state and len(taken) < allowed:
        x = states[-1]
        done = searching.run(x, beliefs[-1], rng, until)
        simulations += done
        if done < search.simulations:
            break
        a = int(searching.q.argmin())
        fails = rng.random() < FAILURE
        taken.append(a)
        states.append(x if fails else int(world.after[x, a]))
        beliefs.append(updated(beliefs[-1], world.likelihood[x, a]))
    search_time_s = perf_counter() - began
    arrived = states[-1] == world.goal_state
    gave_up: Ending = "step limit" if len(taken) == allowed else "time limit"
    return Play(
        Rollout(np.array(states), np.array(taken, int), arrived),
        np.array(beliefs),
        "arrived" if arrived else gave_up,
        simulations,
        searching.solve_time_s,
        search_time_s,
    )
