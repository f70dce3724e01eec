"""The tests of the paper, on trials: chi-square, Mann-Whitney, and normality as a description.

All of them treat trials as independent. That is the paper's choice; it overstates certainty,
because trials of one participant, and trials of one scenario, resemble each other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from .contract import REFERENCE, TREATMENT
from .errors import EmptyArmError
from .estimates import Share, Values, share, without_missing

DEGENERATE_MARGIN = "degenerate_margin"
CONSTANT_OUTCOME = "constant_outcome"
TOO_FEW_VALUES = "too_few_values"

SHAPIRO_LIMIT = 5_000
"""Above this number of values Shapiro-Wilk's p is no longer accurate."""


@dataclass(frozen=True)
class TwoByTwo:
    """Counts of trials: correct and wrong guesses in the treatment and the reference arm."""

    treatment_correct: int
    treatment_wrong: int
    reference_correct: int
    reference_wrong: int
    n_missing_treatment: int = 0
    n_missing_reference: int = 0

    @property
    def arms(self) -> tuple[Share, Share]:
        """Share of correct guesses in the treatment and in the reference arm.

        EmptyArmError if an arm has no trial.
        """
        rows = (
            (TREATMENT, self.treatment_correct, self.treatment_wrong, self.n_missing_treatment),
            (REFERENCE, self.reference_correct, self.reference_wrong, self.n_missing_reference),
        )
        for arm, right, wrong, _ in rows:
            if right + wrong == 0:
                raise EmptyArmError(arm, "guess")
        treatment, reference = (
            share(right, right + wrong, missing) for _, right, wrong, missing in rows
        )
        return treatment, reference


@dataclass(frozen=True)
class ChiSquare:
    """Pearson's chi-square of a 2x2 table; `chi2` and `phi` are None where undefined.

    `phi` is signed: positive when the treatment arm has the larger share.
    """

    chi2: float | None
    df: int
    p: float
    n: int
    n_missing: int
    phi: float | None
    min_expected: float
    warnings: tuple[str, ...] = ()
    method: str = "Pearson's chi-square without continuity correction, on trials"
    source: str = "scipy.stats.chi2_contingency(correction=False)"


@dataclass(frozen=True)
class MannWhitney:
    """Two-sided asymptotic Mann-Whitney test with tie correction.

    `u_treatment` counts the pairs in which the treatment arm's value is larger, ties half;
    `auc` is their share, `rank_biserial` = 2 auc - 1. `z` is None if all values are equal.
    """

    u_treatment: float
    u_reference: float
    u_smaller: float
    sd: float
    z: float | None
    p: float
    n_treatment: int
    n_reference: int
    n_missing: int
    auc: float
    rank_biserial: float
    median_treatment: float
    median_reference: float
    warnings: tuple[str, ...] = ()
    method: str = (
        "Mann-Whitney, two-sided, normal approximation with tie correction, "
        "without continuity correction, on trials"
    )
    source: str = 'scipy.stats.mannwhitneyu(use_continuity=False, method="asymptotic")'


@dataclass(frozen=True)
class Normality:
    """Test of normality, reported and never used to choose a test.

    `statistic` and `p` are None if there are too few values or all are equal. `p_relation` is
    not "=" where the tables end: Anderson-Darling's p is known between .01 and .15 only.
    """

    statistic: float | None
    p: float | None
    p_relation: Literal["=", "<=", ">="]
    n: int
    n_missing: int
    method: str
    source: str
    warnings: tuple[str, ...] = ()


def chi_square(table: TwoByTwo) -> ChiSquare:
    """Test whether both arms guess correctly equally often.

    If nobody, or everybody, was correct the statistic is undefined: p = 1 and a warning.
    EmptyArmError if an arm has no trial. Source: the paper, section 4.4; Pearson (1900).
    """
    from scipy import stats

    treatment, reference = table.arms
    counts = np.array(
        [
            [table.treatment_correct, table.treatment_wrong],
            [table.reference_correct, table.reference_wrong],
        ]
    )
    n = int(counts.sum())
    expected = np.outer(counts.sum(axis=1), counts.sum(axis=0)) / n
    n_missing = table.n_missing_treatment + table.n_missing_reference
    if (counts.sum(axis=0) == 0).any():
        return ChiSquare(None, 1, 1.0, n, n_missing, None, 0.0, (DEGENERATE_MARGIN,))
    result = stats.chi2_contingency(counts, correction=False)
    chi2 = float(result.statistic)
    return ChiSquare(
        chi2=chi2,
        df=1,
        p=float(result.pvalue),
        n=n,
        n_missing=n_missing,
        phi=float(np.copysign((chi2 / n) ** 0.5, treatment.share - reference.share)),
        min_expected=float(expected.min()),
    )


def mann_whitney(treatment: Values, reference: Values, measure: str = "value") -> MannWhitney:
    """Test whether values of one arm tend to be larger; NaN is missing and left out.

    If all values are equal, p = 1 and a warning. EmptyArmError, naming `measure`, if an arm has
    no value. Source: the paper, section 4.4; Mann and Whitney (1947).
    """
    from scipy import stats

    x, missing_x = without_missing(treatment)
    y, missing_y = without_missing(reference)
    for arm, values in ((TREATMENT, x), (REFERENCE, y)):
        if len(values) == 0:
            raise EmptyArmError(arm, measure)
    pairs, n = len(x) * len(y), len(x) + len(y)
    _, ties = np.unique(np.concatenate([x, y]), return_counts=True)
    ties = ties.astype(np.float64)
    tie_term = float((ties**3 - ties).sum()) / (n * (n - 1))
    sd = (pairs / 12 * max(0.0, n + 1 - tie_term)) ** 0.5
    z: float | None
    if len(ties) == 1:
        u, sd, z, p = pairs / 2, 0.0, None, 1.0
    else:
        result = stats.mannwhitneyu(x, y, use_continuity=False, method="asymptotic")
        u, p = float(result.statistic), float(result.pvalue)
        z = (u - pairs / 2) / sd
    return MannWhitney(
        u_treatment=u,
        u_reference=pairs - u,
        u_smaller=min(u, pairs - u),
        sd=sd,
        z=z,
        p=p,
        n_treatment=len(x),
        n_reference=len(y),
        n_missing=missing_x + missing_y,
        auc=u / pairs,
        rank_biserial=2 * u / pairs - 1,
        median_treatment=float(np.median(x)),
        median_reference=float(np.median(y)),
        warnings=(CONSTANT_OUTCOME,) if z is None else (),
    )


def normality(values: Values) -> Normality:
    """Describe how far values are from normal: Shapiro-Wilk to 5,000 values, then Anderson-Darling.

    NaN is missing and left out. Needs three values that are not all equal, else a warning.
    """
    from scipy import stats

    present, n_missing = without_missing(values)
    n = len(present)
    if n <= SHAPIRO_LIMIT:
        method, source = "Shapiro-Wilk", "scipy.stats.shapiro"
    else:
        method, source = "Anderson-Darling", 'scipy.stats.anderson(method="interpolate")'
    if n < 3 or np.ptp(present) == 0:
        warning = TOO_FEW_VALUES if n < 3 else CONSTANT_OUTCOME
        return Normality(None, None, "=", n, n_missing, method, source, (warning,))
    relation: Literal["=", "<=", ">="] = "="
    if n <= SHAPIRO_LIMIT:
        result = stats.shapiro(present)
    else:
        # the stubs misspell the name of the method
        result = stats.anderson(present, method="interpolate")  # type: ignore[call-overload]
        relation = "<=" if result.pvalue <= 0.01 else ">=" if result.pvalue >= 0.15 else "="
    return Normality(
        float(result.statistic), float(result.pvalue), relation, n, n_missing, method, source
    )
