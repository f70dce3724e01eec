"""The arms compared by dealing whole participants anew: exact where that is feasible."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import chain, combinations

import numpy as np
from numpy.typing import NDArray

from . import subset_sums
from .codes import CONSTANT_OUTCOME
from .outcome import Numbers, Outcome
from .participants import by_participant
from .result import TestResult
from .subset_sums import Scores

Chosen = NDArray[np.bool_]

_MOST_ENUMERATED = 50_000
_MOST_COUNTED = 1_000
"""Participants; the number of relabellings of more would have hundreds of digits."""

_MOST_DRAWS, _FEWEST_DRAWS = 9_999, 999
_MOST_DEALT = 100_000_000
"""Participants dealt in all draws together, which takes one or two seconds."""

_ROUNDING = 1e-10
"""Sums that differ by this share of all deviations are the same sum, rounded differently."""


@dataclass(frozen=True, kw_only=True)
class ClusterPermutation(TestResult):
    """Permutation test of the difference of the arms' means of participants' means.

    `exact`: p is the share of all `relabellings`; else that many were drawn at random.
    """

    p: float
    exact: bool
    relabellings: int
    participants_treatment: int
    participants_reference: int


def cluster_permutation(outcome: Outcome, rng: np.random.Generator) -> ClusterPermutation:
    """Test the difference of participants' means by dealing participants anew to the arms.

    Two-sided: p is the share of relabellings whose difference is at least as large. Exact if the
    measure has whole values, or there are at most 50,000 relabellings; else by up to 9,999 draws
    from `rng`, as `method` says, where the observed one counts as one draw more. Each participant
    belongs to one arm. EmptyArmError if an arm has no value. Source: Streitberg and Röhmel (1986),
    shift algorithm; Phipson and Smyth (2010), p from draws.
    """
    people = by_participant(outcome)
    means, treated = people.means, people.treated
    whole = _whole(people.sums, people.trials)
    p, exact, relabellings = _permute(means, whole, treated, rng)
    return ClusterPermutation(
        estimate=float(means[treated].mean() - means[~treated].mean()),
        null=0.0,
        unit=outcome.unit,
        p=p,
        n=len(means),
        n_missing=people.n_missing,
        method="difference of participants' means, participants permuted between the arms, "
        + ("exact" if exact else f"Monte Carlo of {relabellings:,} draws"),
        source="Streitberg and Röhmel (1986), Statistical Software Newsletter 12, 10-17"
        if exact
        else "Phipson and Smyth (2010), Stat. Appl. Genet. Mol. Biol. 9, 39",
        of="participants",
        warnings=() if np.ptp(means) else (CONSTANT_OUTCOME,),
        exact=exact,
        relabellings=relabellings,
        participants_treatment=int(treated.sum()),
        participants_reference=int((~treated).sum()),
    )


def _whole(sums: Numbers, trials: NDArray[np.int64]) -> Scores | None:
    """Return participants' means as whole numbers of a common unit, None if there is none."""
    multiple = math.lcm(*np.unique(trials).tolist())
    exceeding = multiple * float(np.abs(sums).max()) * len(sums) > 2**53
    if exceeding or not np.array_equal(sums, np.rint(sums)):
        return None
    whole: Scores = sums.astype(np.int64) * (multiple // trials)
    return whole


def _permute(
    means: Numbers, whole: Scores | None, treated: Chosen, rng: np.random.Generator
) -> tuple[float, bool, int]:
    """Return p, whether it is exact, and the number of relabellings it rests on."""
    n, arm = len(means), treated if 2 * treated.sum() <= len(means) else ~treated
    size = int(arm.sum())
    if whole is not None and subset_sums.feasible(whole, size):
        return subset_sums.two_sided_p(whole, arm), True, math.comb(n, size)
    # the arms' difference is proportional to one arm's sum of deviations
    deviations = means - means.mean()
    observed = abs(deviations[arm].sum()) - _ROUNDING * np.abs(deviations).sum()
    if n <= _MOST_COUNTED and math.comb(n, size) <= _MOST_ENUMERATED:
        every = np.fromiter(chain.from_iterable(combinations(range(n), size)), np.int64)
        relabelled = deviations[every.reshape(-1, size)].sum(axis=1)
        return float((np.abs(relabelled) >= observed).mean()), True, len(relabelled)
    draws = max(_FEWEST_DRAWS, min(_MOST_DRAWS, _MOST_DEALT // n))
    as_far = sum(
        abs(deviations[rng.choice(n, size, replace=False, shuffle=False)].sum()) >= observed
        for _ in range(draws)
    )
    return float(1 + as_far) / (1 + draws), False, draws
