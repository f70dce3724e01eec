"""Who left: whether one arm lost more participants, and the comparison with and without them."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import EmptyArmError
from .outcome import UNKNOWN, Outcome
from .result import TestResult
from .two_by_two import TwoByTwo, fisher_exact, risk_difference


@dataclass(frozen=True, kw_only=True)
class Dropout(TestResult):
    """Difference of the shares who left, positive if more left in the treatment arm.

    `left_*` of `participants_*` of each arm did not complete. `fisher_p` is of another test than
    the interval, which may exclude 0 where Fisher's exact test does not reject it: it is no `p`.
    """

    fisher_p: float
    left_treatment: int
    left_reference: int
    participants_treatment: int
    participants_reference: int


def differential_dropout(treated: NDArray[np.bool_], completed: NDArray[np.bool_]) -> Dropout:
    """Compare how many participants of each arm left; both arrays of shape (P,), one each.

    Whom to count (everybody dealt, or everybody who began) is the caller's choice. Newcombe's
    interval, and Fisher's exact p, 1 if nobody, or everybody, left. EmptyArmError if an arm has no
    participant. Source: Newcombe (1998), method 10; Fisher (1935).
    """
    for arm, of_arm in (("treatment", treated), ("reference", ~treated)):
        if not of_arm.any():
            raise EmptyArmError(arm, "participant")
    stayed_treatment, left_treatment, stayed_reference, left_reference = (
        int((of_arm & stayed).sum())
        for of_arm in (treated, ~treated)
        for stayed in (completed, ~completed)
    )
    table = TwoByTwo(left_treatment, stayed_treatment, left_reference, stayed_reference)
    difference = risk_difference(table)
    return Dropout(
        estimate=difference.estimate,
        low=difference.low,
        high=difference.high,
        null=0.0,
        unit="share",
        n=table.n,
        n_missing=0,
        method="difference of the shares who left with Newcombe's interval, 95 %; "
        "Fisher's exact test, two-sided",
        source="Newcombe (1998), Statistics in Medicine 17, 873-890; scipy.stats.fisher_exact",
        of="participants",
        fisher_p=fisher_exact(table).p,
        left_treatment=left_treatment,
        left_reference=left_reference,
        participants_treatment=left_treatment + stayed_treatment,
        participants_reference=left_reference + stayed_reference,
    )


def completers(outcome: Outcome, completed: NDArray[np.bool_]) -> Outcome:
    """Return the trials of those who completed; `completed[p]` tells it of participant number p.

    A comparison of those who stayed: no longer protected by the random dealing of conditions.
    """
    return _taken(outcome, np.flatnonzero(completed[outcome.participant]))


def intention_to_treat(outcome: Outcome, trials_dealt: int, missing: float) -> Outcome:
    """Return all trials dealt to everybody who played one, `missing` standing for those not played.

    What is analysed is the condition as dealt, whatever became of the participant. Each gets
    `trials_dealt` trials: trials without a value, and trials never reached, count as `missing`,
    which should be the worst case of the measure: 0 (wrong) for correct guesses, the full length,
    on average, for time. Which scenarios were never reached is unknown, so these trials are of
    scenario `UNKNOWN`. Participants who were dealt a condition but saw no trial are not in it: they
    never met the condition. Where the length of the lists is unknown this cannot be computed, and
    `outcome` itself, with the trials there are, is the nearest to it.
    """
    played = np.bincount(outcome.participant)
    short = np.where(played > 0, np.maximum(trials_dealt - played, 0), 0)
    _, first = np.unique(outcome.participant, return_index=True)
    filled = _taken(
        outcome, np.concatenate([np.arange(len(outcome.y)), np.repeat(first, short[played > 0])])
    )
    added = np.arange(len(filled.y)) >= len(outcome.y)
    return dataclasses.replace(
        filled,
        y=np.where(added | np.isnan(filled.y), missing, filled.y),
        scenario=np.where(added, UNKNOWN, filled.scenario),
    )


def _taken(outcome: Outcome, trials: NDArray[np.int64]) -> Outcome:
    """Return the trials of these numbers."""
    return dataclasses.replace(
        outcome,
        y=outcome.y[trials],
        treated=outcome.treated[trials],
        participant=outcome.participant[trials],
        scenario=outcome.scenario[trials],
    )
