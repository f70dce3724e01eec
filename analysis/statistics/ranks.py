"""Two arms compared by ranks.

These tests treat values as independent. On trials that is the paper's choice; it overstates
certainty, because trials of one participant, and trials of one scenario, resemble each other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import EmptyArmError
from .codes import CONSTANT_OUTCOME
from .estimates import Values, without_missing
from .result import TestResult


@dataclass(frozen=True, kw_only=True)
class MannWhitney(TestResult):
    """Two-sided asymptotic Mann-Whitney test with tie correction; the estimate is the AUC.

    `u_treatment` counts the pairs in which the treatment arm's value is larger, ties half; the
    AUC is their share, `rank_biserial` = 2 AUC - 1. The statistic is z, None if all values are
    equal; `sd` is U's under the null hypothesis.
    """

    p: float
    u_treatment: float
    u_reference: float
    u_smaller: float
    sd: float
    n_treatment: int
    n_reference: int
    rank_biserial: float
    median_treatment: float
    median_reference: float


def mann_whitney(
    treatment: Values, reference: Values, measure: str = "value", of: str = "trials"
) -> MannWhitney:
    """Test whether values of one arm tend to be larger; NaN is missing and left out.

    If all values are equal, p = 1 and a warning. EmptyArmError, naming `measure`, if an arm has
    no value. `of` names what has the values. Source: the paper, section 4.4; Mann and Whitney
    (1947).
    """
    from scipy import stats

    x, y, n_missing = _present(treatment, reference, measure)
    pairs = len(x) * len(y)
    sd = _sd_of_u(x, y)
    u, p, z = pairs / 2, 1.0, None
    if sd > 0:
        result = stats.mannwhitneyu(x, y, use_continuity=False, method="asymptotic")
        u, p = float(result.statistic), float(result.pvalue)
        z = (u - pairs / 2) / sd
    return MannWhitney(
        estimate=u / pairs,
        low=None,
        high=None,
        null=0.5,
        unit="probability",
        symbol="z",
        statistic=z,
        df=None,
        p=p,
        n=len(x) + len(y),
        n_missing=n_missing,
        method=(
            "Mann-Whitney, two-sided, normal approximation with tie correction, "
            f"without continuity correction, on {of}"
        ),
        source='scipy.stats.mannwhitneyu(use_continuity=False, method="asymptotic")',
        of=of,
        warnings=(CONSTANT_OUTCOME,) if z is None else (),
        u_treatment=u,
        u_reference=pairs - u,
        u_smaller=min(u, pairs - u),
        sd=sd,
        n_treatment=len(x),
        n_reference=len(y),
        rank_biserial=2 * u / pairs - 1,
        median_treatment=float(np.median(x)),
        median_reference=float(np.median(y)),
    )


def _present(
    treatment: Values, reference: Values, measure: str
) -> tuple[NDArray[np.float64], NDArray[np.float64], int]:
    """Return both arms without their missing values, and how many those were."""
    x, missing_x = without_missing(treatment)
    y, missing_y = without_missing(reference)
    for arm, values in (("treatment", x), ("reference", y)):
        if len(values) == 0:
            raise EmptyArmError(arm, measure)
    return x, y, missing_x + missing_y


def _sd_of_u(x: NDArray[np.float64], y: NDArray[np.float64]) -> float:
    """Standard deviation of U if the arms do not differ, corrected for ties."""
    n = len(x) + len(y)
    _, counted = np.unique(np.concatenate([x, y]), return_counts=True)
    if len(counted) == 1:
        return 0.0
    ties = counted.astype(np.float64)
    tie_term = float((ties**3 - ties).sum()) / (n * (n - 1))
    return float((len(x) * len(y) / 12 * (n + 1 - tie_term)) ** 0.5)
