"""How legible a trajectory was: the measures of both frameworks and the observer's belief."""

from dataclasses import dataclass

import numpy as np

from policies.certificate import LARGEST_STRETCH
from policies.errors import ModelError
from policies.maze import FAILURE
from policies.mdp import Array
from policies.observer import Distance, belief_distance, steps_until_sure
from policies.rollout import Rollout


@dataclass(frozen=True, eq=False)
class Legibility:
    """Measures of one trajectory of T steps, whatever policy it came from.

    polmdp: sum_t gamma^t r_leg(x_t, a_t) over the steps t = 0..T-1; it favours long paths.
    polmdp_per_step: the mean of r_leg(x_t, a_t) over the steps, undiscounted.
    lmdp: sum_t gamma^t dist(b_t, b*) over t = 0..T; smaller is more legible; infinite for `kl`
    once the belief in the goal is 0.
    belief_curve: b_t(g), shape (T + 1,).
    steps_until_half, steps_until_sure: steps until b(g) first exceeds .5, .8 (T if never).
    share_until_half, share_until_sure: these as shares of T.
    belief_area: area under the belief curve over the share of the path walked, 0 to 1.
    Without a step (T = 0) the mean and the shares are nan and the area is b_0(g).
    """

    polmdp: float
    polmdp_per_step: float
    lmdp: float
    belief_curve: Array
    steps_until_half: int
    steps_until_sure: int
    share_until_half: float
    share_until_sure: float
    belief_area: float


def measure_legibility(
    rollout: Rollout,
    goal: int,
    r_leg: Array,
    beliefs: Array,
    gamma: float = 0.9,
    distance: Distance = "tv",
) -> Legibility:
    """Measure a trajectory towards the goal with index `goal` (paper, 4.2).

    `r_leg[n, x, a]`; `beliefs[t, n]` of an observer who watched all of it, shape (T + 1, N).
    """
    T = rollout.steps
    if beliefs.shape != (T + 1, len(r_leg)):
        raise ModelError(
            f"expected beliefs of shape {(T + 1, len(r_leg))} for {T} steps and {len(r_leg)} "
            f"goals, came {beliefs.shape}"
        )
    far = belief_distance(beliefs, goal, distance)
    r = r_leg[goal, rollout.states[:-1], rollout.actions]
    curve = beliefs[:, goal]
    half, sure = (steps_until_sure(beliefs, goal, threshold) for threshold in (0.5, 0.8))
    return Legibility(
        polmdp=float(gamma ** np.arange(T) @ r),
        polmdp_per_step=float(r.mean()) if T else np.nan,
        lmdp=float(gamma ** np.arange(T + 1) @ far),
        belief_curve=curve,
        steps_until_half=half,
        steps_until_sure=sure,
        share_until_half=half / T if T else np.nan,
        share_until_sure=sure / T if T else np.nan,
        belief_area=float(np.trapezoid(curve) / T if T else curve[0]),
    )


def steps_allowed(distance: float) -> int:
    """Steps within which a run counts as arrived: 4 x distance / .85 (moves fail), rounded up."""
    return int(np.ceil(LARGEST_STRETCH * distance / (1 - FAILURE)))
