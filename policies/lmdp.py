"""L-MDP, the baseline: plays made legible by searching over what an observer believes."""

from collections.abc import Mapping
from dataclasses import dataclass
from time import perf_counter
from types import MappingProxyType
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np
from scipy.special import softmax

from policies.errors import ModelError
from policies.maze import ACTION_SETS, FAILURE, Maze
from policies.mdp import Array
from policies.measures import steps_allowed
from policies.observer import OBSERVER_BETA, updated
from policies.polmdp import ActionSet
from policies.rollout import Rollout
from policies.solvers import cells_after, distances, goal_values, shortest_path_policy

if TYPE_CHECKING:
    from policies.lmdp_kernels import World

StageCost = Literal["tv", "euclid", "kl", "reported"]
Rollouts = Literal["optimal", "random"]
Ending = Literal["arrived", "step limit", "time limit"]

STEPS_BETWEEN_LOOKS = 10_000
"""Simulated steps between two looks at the clock: about a millisecond."""


@dataclass(frozen=True)
class Search:
    """Parameters of the search; the defaults are Miura, Cohen & Zilberstein (RO-MAN 2021).

    distance: of a stage's belief, one of belief_distance or sqrt(1 - b(g)^2) (`reported`).
    task: added to it for each step. simulations, depth: of each real step. exploration: UCB1's c.
    rollouts: the policy that values a new leaf. gamma: discount of the goals' MDPs; the search
    itself is bounded by its depth alone (discounted it loiters). beta: the observer's.
    root_only: no tree, a bandit of the next actions. forgets: every step is planned from the
    uniform belief. time_limit_s: of a whole play.
    """

    distance: StageCost = "tv"
    task: float = 0.1
    simulations: int = 10_000
    depth: int = 30
    exploration: float = 1.0
    rollouts: Rollouts = "optimal"
    gamma: float = 0.9
    beta: float = OBSERVER_BETA
    actions: ActionSet = "udlrn"
    root_only: bool = False
    forgets: bool = False
    time_limit_s: float = np.inf

    def __post_init__(self) -> None:
        for name in ("simulations", "depth"):
            if getattr(self, name) < 1:
                raise ModelError(f"expected {name} of at least 1, came {getattr(self, name)}")
        for name in ("task", "exploration"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0):
                raise ModelError(f"expected a finite {name} of at least 0, came {value}")
        if not (np.isfinite(self.beta) and self.beta > 0):
            raise ModelError(f"expected a finite beta above 0, came {self.beta}")
        if not 0 <= self.gamma < 1:
            raise ModelError(f"expected gamma in [0, 1), came {self.gamma}")
        if not self.time_limit_s > 0:
            raise ModelError(f"expected a time limit above 0 s, came {self.time_limit_s}")
        for name, allowed in (
            ("distance", get_args(StageCost)),
            ("rollouts", get_args(Rollouts)),
            ("actions", get_args(ActionSet)),
        ):
            value = getattr(self, name)
            if value not in allowed:
                raise ModelError(f"expected {name} in {', '.join(allowed)}; came {value!r}")


SEARCHES: Mapping[str, Search] = MappingProxyType(
    {
        "miura": Search(),
        "as_reported": Search(
            distance="reported", task=0.0, depth=10, root_only=True, forgets=True
        ),
    }
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
    """The search for one goal of a maze, ready to run from any state and belief."""

    def __init__(self, maze: Maze, goal: str, search: Search) -> None:
        # Compiled code loads late: only who searches waits for it.
        from policies import lmdp_kernels

        self.kernels, self.search, self.goal_state = lmdp_kernels, search, maze.goals[goal]
        began = perf_counter()
        self.world = self._world(maze, maze.goal_index(goal))
        self.solve_time_s = perf_counter() - began
        A, N = self.world.likelihood.shape[1:]
        self.costs = lmdp_kernels.Costs(get_args(StageCost).index(search.distance), search.task)
        self.tree = lmdp_kernels.empty_tree(search.simulations + 1, A, N)
        self.prior = np.full(N, 1 / N)
        # Compiled here, before the clock of a play's search runs.
        rng = np.random.default_rng(0)
        self.run(self.goal_state, self.prior, rng, until=-np.inf)
        self._simulate(0, rng)

    def run(self, x: int, belief: Array, rng: np.random.Generator, until: float = np.inf) -> int:
        """Search from a state and belief (N,); the cost of each action is in `tree.q[0]`.

        Ends early when perf_counter() passes `until`; returns the simulations run.
        """
        self.kernels.plant(self.tree, self.world, self.costs, x, belief)
        done, chunk = 0, max(1, STEPS_BETWEEN_LOOKS // self.search.depth)
        while done < self.search.simulations and perf_counter() < until:
            chunk = min(chunk, self.search.simulations - done)
            self._simulate(chunk, rng)
            done += chunk
        return done

    def _simulate(self, simulations: int, rng: np.random.Generator) -> None:
        how = self.search
        self.kernels.simulate(
            self.tree,
            self.world,
            self.costs,
            how.depth,
            how.exploration,
            how.root_only,
            simulations,
            rng,
        )

    def _world(self, maze: Maze, n: int) -> "World":
        actions = ACTION_SETS[self.search.actions]
        q = goal_values(maze, self.search.gamma, actions)
        if self.search.rollouts == "optimal":
            policy = shortest_path_policy(maze, self.goal_state, actions)
        else:
            policy = np.full(q.shape[1:], 1 / len(actions))
        upto = policy.cumsum(axis=1)
        return self.kernels.World(
            cells_after(maze, actions),
            np.ascontiguousarray(softmax(self.search.beta * q, axis=2).transpose(1, 2, 0)),
            upto / upto[:, -1:],
            n,
            self.goal_state,
            FAILURE,
        )


def play_lmdp(
    maze: Maze,
    start: int,
    goal: str,
    rng: np.random.Generator,
    search: Search = SEARCHES["miura"],
) -> Play:
    """Plan and act step by step until the goal, the steps allowed (4 x distance / .85) or time.

    The time limit covers solving and searching, not the compiling of the search on first use;
    the same seed gives the same play wherever the limit is not reached.
    ModelError for a start outside the maze or in a closed room, MazeError for an unknown goal.
    """
    n = maze.goal_index(goal)
    if not 0 <= start < maze.states:
        raise ModelError(f"expected a start from 0 to {maze.states - 1}, came {start}")
    distance = float(distances(maze)[n, start])
    if distance < 0:
        raise ModelError(f"expected a start with a way to the goals, came {start}")
    allowed = steps_allowed(distance)
    searching = TreeSearch(maze, goal, search)
    world, tree = searching.world, searching.tree
    began = perf_counter()
    until = began + search.time_limit_s - searching.solve_time_s
    states, taken, beliefs, simulations = [start], list[int](), [searching.prior], 0
    while states[-1] != world.goal_state and len(taken) < allowed:
        x, belief = states[-1], beliefs[-1]
        done = searching.run(x, searching.prior if search.forgets else belief, rng, until)
        simulations += done
        if done < search.simulations:
            break
        a = int(tree.q[0].argmin())
        fails = rng.random() < FAILURE
        taken.append(a)
        states.append(x if fails else int(world.after[x, a]))
        beliefs.append(updated(belief, world.likelihood[x, a]))
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
