"""Correct guesses of two arms: the 2x2 table, its tests and its effect sizes.

All of them treat trials as independent. That is the paper's choice; it overstates certainty,
because trials of one participant, and trials of one scenario, resemble each other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import EmptyArmError
from .codes import DEGENERATE_MARGIN
from .estimates import Share, share
from .result import TestResult


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
    def counts(self) -> NDArray[np.int64]:
        """The table, shape (2, 2): rows treatment and reference, columns correct and wrong."""
        return np.array(
            [
                [self.treatment_correct, self.treatment_wrong],
                [self.reference_correct, self.reference_wrong],
            ]
        )

    @property
    def n(self) -> int:
        """How many trials were counted."""
        return int(self.counts.sum())

    @property
    def n_missing(self) -> int:
        """How many trials of both arms lack a guess."""
        return self.n_missing_treatment + self.n_missing_reference

    @property
    def is_degenerate(self) -> bool:
        """Whether nobody, or everybody, was correct."""
        return bool((self.counts.sum(axis=0) == 0).any())

    @property
    def arms(self) -> tuple[Share, Share]:
        """Share of correct guesses in the treatment and in the reference arm.

        EmptyArmError if an arm has no trial.
        """
        rows = (
            ("treatment", self.treatment_correct, self.treatment_wrong, self.n_missing_treatment),
            ("reference", self.reference_correct, self.reference_wrong, self.n_missing_reference),
        )
        for arm, right, wrong, _ in rows:
            if right + wrong == 0:
                raise EmptyArmError(arm, "guess")
        treatment, reference = (
            share(right, right + wrong, missing) for _, right, wrong, missing in rows
        )
        return treatment, reference


@dataclass(frozen=True, kw_only=True)
class ChiSquare(TestResult):
    """Chi-square of a 2x2 table; the estimate is phi, both None where undefined.

    Phi is positive when the treatment arm has the larger share. `min_expected` is the smallest
    count expected if the arms did not differ.
    """

    p: float
    min_expected: float


def chi_square(table: TwoByTwo) -> ChiSquare:
    """Test whether both arms guess correctly equally often.

    If nobody, or everybody, was correct the statistic is undefined: p = 1 and a warning.
    EmptyArmError if an arm has no trial. Source: the paper, section 4.4; Pearson (1900).
    """
    from scipy import stats

    treatment, reference = table.arms
    phi = chi2 = None
    p, min_expected = 1.0, 0.0
    if not table.is_degenerate:
        result = stats.chi2_contingency(table.counts, correction=False)
        chi2, p = float(result.statistic), float(result.pvalue)
        phi = float(np.copysign((chi2 / table.n) ** 0.5, treatment.share - reference.share))
        min_expected = float(result.expected_freq.min())
    return ChiSquare(
        estimate=phi,
        low=None,
        high=None,
        null=0.0,
        unit="correlation",
        symbol="chi2",
        statistic=chi2,
        df=1,
        p=p,
        n=table.n,
        n_missing=table.n_missing,
        method="Pearson's chi-square without continuity correction, on trials",
        source="scipy.stats.chi2_contingency(correction=False)",
        warnings=(DEGENERATE_MARGIN,) if table.is_degenerate else (),
        min_expected=min_expected,
    )
