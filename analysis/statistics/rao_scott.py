"""Chi-square of correct guesses, corrected for participants as clusters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .codes import NO_VARIATION, ONE_PARTICIPANT, ZERO_CELL
from .influence import cluster_count, cluster_variance
from .outcome import Outcome
from .result import TestResult
from .two_by_two import TwoByTwo, chi_square


@dataclass(frozen=True, kw_only=True)
class RaoScott(TestResult):
    """Chi-square of a 2x2 table over its design effect, an F; the estimate is phi.

    `chi2` is Pearson's without correction, `p_chi2` that of chi2 / design_effect on 1 degree of
    freedom; None where undefined.
    """

    df: tuple[float, float]
    chi2: float | None
    design_effect: float | None
    p_chi2: float | None


def rao_scott(outcome: Outcome) -> RaoScott:
    """Test whether both arms guess correctly equally often, trials clustered by participant.

    `y` is 0 or 1. Undefined if a cell is empty or an arm has a single participant; p is 1 if all
    trials are alike. EmptyArmError if an arm has no value. Source: Rao and Scott (1984), Annals
    of Statistics 12, 46-60; as R's survey::svychisq.
    """
    from scipy.special import chdtrc, fdtrc

    data = outcome.present()
    cell = 2 * (~data.treated) + (data.y == 0)
    counts = np.bincount(cell, minlength=4)
    pearson = chi_square(TwoByTwo(*counts.tolist()))
    df = cluster_count(data.participant) - 1
    chi2 = pearson.statistic
    effect, warnings = (
        (None, pearson.warnings) if chi2 is None else _design_effect(data, cell, counts)
    )
    p = pearson.p if chi2 is None else None
    f = p_chi2 = None
    if chi2 is not None and effect is not None:
        f = chi2 / effect
        p, p_chi2 = float(fdtrc(1, df, f)), float(chdtrc(1, f))
    return RaoScott(
        estimate=pearson.estimate,
        null=0.0,
        unit=pearson.unit,
        symbol="F",
        statistic=f,
        df=(1, df),
        p=p,
        n=pearson.n,
        n_missing=outcome.n_missing,
        method="Rao-Scott chi-square, trials clustered by participant",
        source="Rao and Scott (1984), Annals of Statistics 12, 46-60; as R's survey::svychisq",
        warnings=warnings,
        chi2=chi2,
        design_effect=effect,
        p_chi2=p_chi2,
    )


def _design_effect(
    data: Outcome, cell: NDArray[np.int64], counts: NDArray[np.int64]
) -> tuple[float | None, tuple[str, ...]]:
    """Return the variance of the log odds ratio by participants over that of independent trials.

    None and a warning where it is undefined or nothing.
    """
    if not counts.all():
        return None, (ZERO_CELL,)
    if min(cluster_count(data.participant[arm]) for arm in (data.treated, ~data.treated)) == 1:
        return None, (ONE_PARTICIPANT,)
    influence = np.array([1, -1, -1, 1]) / counts
    variance = cluster_variance(influence[cell], data.participant)
    if not variance:
        return None, (NO_VARIATION,)
    return variance / float((1 / counts).sum()), ()
