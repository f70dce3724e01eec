"""PoLMDP: policies that are legible because the reward is the observer's posterior."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from scipy.special import log_softmax

from policies.certificate import Certificate, certify
from policies.errors import ModelError
from policies.maze import ACTION_SETS, FAILURE, Action, Maze
from policies.maze_solver import Variant, least_cost, maze_rewards, solve_maze
from policies.mdp import Array, uniform_over
from policies.priors import normalised
from policies.solvers import shortest_path_policy, ties

Formulation = Literal["reward", "cost"]
ActionSet = Literal["udlr", "udlrn"]


@dataclass(frozen=True)
class Parameters:
    """Parameters of a legible policy; the defaults are the preset `paper`.

    beta: inverse temperature of the posterior, on unscaled Q. gamma: discount in [0, 1).
    formulation: `reward` (the paper's) or `cost` (provably arrives). guard: put shortest-path
    actions where the certificate fails.
    """

    beta: float = 0.5
    gamma: float = 0.9
    formulation: Formulation = "reward"
    variant: Variant = "as_printed"
    actions: ActionSet = "udlrn"
    guard: bool = False

    def __post_init__(self) -> None:
        if not (np.isfinite(self.beta) and self.beta > 0):
            raise ModelError(f"expected a finite beta above 0, came {self.beta}")
        if not 0 <= self.gamma < 1:
            raise ModelError(f"expected gamma in [0, 1), came {self.gamma}")
        for name, value, allowed in (
            ("formulation", self.formulation, get_args(Formulation)),
            ("variant", self.variant, get_args(Variant)),
            ("actions", self.actions, get_args(ActionSet)),
        ):
            if value not in allowed:
                raise ModelError(f"expected {name} in {', '.join(allowed)}; came {value!r}")


@dataclass(frozen=True, eq=False)
class LegiblePlan:
    """All that was computed for one goal: values, rewards, both policies, and what is proved.

    `prior[n]` of the goals, `q[n, x, a]`, `r_leg[n, x, a]`, `v_legible[x]` (of the unguarded
    policy; an expected cost in the cost formulation), `policy_optimal[x, a]`,
    `policy_legible[x, a]`; `repaired[x]` marks the states where the guard put shortest-path
    actions.
    """

    maze: Maze
    goal: str
    parameters: Parameters
    prior: Array
    q: Array
    r_leg: Array
    v_legible: Array
    policy_optimal: Array
    policy_legible: Array
    repaired: NDArray[np.bool_]
    certificate: Certificate


def plan_legible(
    maze: Maze, goal: str, parameters: Parameters | None = None, prior: Array | None = None
) -> LegiblePlan:
    """Plan a legible policy for one of the maze's goals (paper, section 3).

    `prior[n]`: what the observer believes of the goals beforehand, as weights above 0 in the
    order of their letters (`goal_prior`); uniform if None.
    """
    parameters = parameters or Parameters()
    n, target = maze.goal_index(goal), maze.goals[goal]
    actions = ACTION_SETS[parameters.actions]
    q, r_leg = maze_rewards(
        maze, parameters.gamma, actions, parameters.beta, parameters.variant, prior
    )
    optimal = shortest_path_policy(maze, target, actions)
    if parameters.formulation == "reward":
        solution = solve_maze(maze, r_leg[n], parameters.gamma, actions)
        v, legible = solution.v, towards(ties(solution.q), optimal)
    else:
        # Summed over the other goals: 1 - r_leg would lose all digits of a small cost.
        cost = sum((r_leg[m] for m in range(len(r_leg)) if m != n), np.zeros_like(r_leg[n]))
        v, legible = _least_cost(maze, target, cost, actions)
        legible[target] = optimal[target]
    repaired = np.zeros(maze.states, bool)
    if parameters.guard:
        legible, repaired = guard(maze, target, legible, optimal, actions)
    certificate = certify(maze, legible, target, actions)
    believed = normalised(prior, len(maze.goals))
    return LegiblePlan(
        maze, goal, parameters, believed, q, r_leg, v, optimal, legible, repaired, certificate
    )


def towards(tied: NDArray[np.bool_], optimal: Array) -> Array:
    """Share each state's probability over its tied actions (S, A), first those on shortest paths.

    A step of a shortest path ties with another action only where the rewards are equal to
    machine precision (one goal, a saturated posterior); there the robot would walk at random.
    """
    shortest = tied & (optimal > 0)
    return uniform_over(np.where(shortest.any(axis=1, keepdims=True), shortest, tied))


def legible_rewards(
    q: Array, beta: float, variant: Variant = "as_printed", prior: Array | None = None
) -> Array:
    """r_leg[n, x, a], the observer's posterior of goal n after action a in x (paper eqs. 5-6).

    `prior[n]`: uniform if None. Of q alone: where that is 0, as in closed rooms, it is the prior.
    """
    return np.exp(log_legible_rewards(q, beta, variant, prior))


def log_legible_rewards(
    q: Array, beta: float, variant: Variant = "as_printed", prior: Array | None = None
) -> Array:
    """Logarithm of `legible_rewards`, shape (N, S, A), computed without leaving log space.

    `as_printed` weighs goals by exp(beta Q_n); `proper_posterior` by P(a | x, n), normalised
    over actions first; `advantage` by exp(beta (Q_n - V_n)).
    """
    weight = beta * q
    if variant == "proper_posterior":
        weight = log_softmax(weight, axis=2)
    elif variant == "advantage":
        weight = weight - weight.max(axis=2, keepdims=True)
    if prior is not None:
        weight = weight + np.log(normalised(prior, len(q)))[:, None, None]
    log_r: Array = log_softmax(weight, axis=0)
    return log_r


def guard(
    maze: Maze, goal: int, policy: Array, optimal: Array, actions: Sequence[Action]
) -> tuple[Array, NDArray[np.bool_]]:
    """Put the shortest-path actions where certification fails; the result is always certified.

    One round is enough: with d the distance, a repaired state needs at most one move more than
    states at d - 1, hence at most 4 d by induction, which is less than before; so no state that
    held becomes slower. Returns the policy (S, A) and the repaired states (S,).
    """
    repaired = certify(maze, policy, goal, actions).fails_at
    return np.where(repaired[:, None], optimal, policy), repaired


def _least_cost(
    maze: Maze, goal: int, cost: Array, actions: Sequence[Action]
) -> tuple[Array, Array]:
    """Least expected undiscounted cost until the goal, (S,), and the policy that attains it.

    Costs below machine precision tie with standing still; of tied actions only those that make
    headway are kept, so the goal is always reached.
    """
    after = maze.successors[:, list(actions)]
    moves = after != np.arange(maze.states)[:, None]
    v = least_cost(maze, goal, cost)
    tied = ties(-(cost + FAILURE * v[:, None] + (1 - FAILURE) * v[after]))
    level = tied & moves & (v[after] <= v[:, None])
    x, a = np.nonzero(level)
    steps = coo_array((np.ones(len(x)), (after[x, a], x)), (maze.states, maze.states))
    hops: Array = dijkstra(steps.tocsr(), unweighted=True, indices=[goal])[0]
    headway = level & ((v[after] < v[:, None]) | (hops[after] < hops[:, None]))
    nowhere_to_go = ~maze.reaches_goal
    nowhere_to_go[goal] = True
    headway[nowhere_to_go] = tied[nowhere_to_go]
    return v, uniform_over(headway)
