"""Where participants or scenarios are too few for a two-way test to be taken at its word.

By `goalguess level --sds .8/.5/.8,.8/0/0 --tests two_way_difference,two_way_auc --participants N/M
--trials K --scenarios J --replicates 20000`: equal arms stay at .06 or below at nominal .05, down
to 2 + 2; 4 + 12 reach .078, 8 + 32 .072, 12 + 36 .064. Trials, from 1 to 100, change little.
"""

from __future__ import annotations

from collections.abc import Sequence

from .codes import FEW_AND_UNEQUAL, FEW_CLUSTERS
from .inference import FEW

_LEAST = 20
"""Arms of every size whose level was above .06 differ by more than 1/20 in 1/participants."""


def few(participants: Sequence[int], scenarios: int) -> tuple[str, ...]:
    """Return the warning, if any, for an arm's or two arms' participants, at least two in each.

    `scenarios` is 0 where none is known. Of two warnings that apply, the one that says more.
    """
    if _few_and_unequal(min(participants), max(participants), scenarios):
        return (FEW_AND_UNEQUAL,)
    return (FEW_CLUSTERS,) if min(*participants, scenarios or FEW) < FEW else ()


def _few_and_unequal(n: int, m: int, scenarios: int) -> bool:
    """Tell whether a true null is rejected in more than 6 % of studies of n < m participants.

    Participants' sums are skewed; in the difference of the arms that cancels as far as 1/n and 1/m
    are the same. Where scenarios, not participants, bind the degrees of freedom, the test holds its
    level all the same. Source: Cressie and Whitford (1986), Biometrical Journal 28, 131-148.
    """
    return _LEAST * (m - n) > n * m and not 0 < scenarios - 1 <= _welch(n, m)


def _welch(n: int, m: int) -> float:
    """Return Welch's degrees of freedom of arms that vary alike."""
    return (1 / n + 1 / m) ** 2 / (1 / (n**2 * (n - 1)) + 1 / (m**2 * (m - 1)))
