"""Correct guesses of two arms: the 2x2 table, its tests and its effect sizes.

All of them treat trials as independent. That is the paper's choice; it overstates certainty,
because trials of one participant, and trials of one scenario, resemble each other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..errors import EmptyArmError
from .codes import DEGENERATE_MARGIN, ZERO_CELL
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
        self.require_both_arms()
        (a, b), (c, d) = self.counts.tolist()
        return share(a, a + b, self.n_missing_treatment), share(c, c + d, self.n_missing_reference)

    def require_both_arms(self) -> None:
        """Raise EmptyArmError if an arm has no trial."""
        for arm, row in zip(("treatment", "reference"), self.counts, strict=True):
            if row.sum() == 0:
                raise EmptyArmError(arm, "guess")


@dataclass(frozen=True, kw_only=True)
class ChiSquare(TestResult):
    """Test of independence in a 2x2 table; the estimate is phi, None where undefined.

    Phi is positive when the treatment arm has the larger share. `min_expected` is the smallest
    count expected if the arms did not differ.
    """

    p: float
    min_expected: float


@dataclass(frozen=True, kw_only=True)
class FisherExact(TestResult):
    """Fisher's exact test; the estimate is the conditional odds ratio."""

    p: float


@dataclass(frozen=True, kw_only=True)
class OddsRatio(TestResult):
    """Odds of a correct guess in the treatment arm over those in the reference arm.

    `sample` is the plain ratio of the counts, None with a zero cell; there the estimate and its
    interval come from counts each raised by a half.
    """

    sample: float | None


def chi_square(table: TwoByTwo, *, yates: bool = False) -> ChiSquare:
    """Pearson's test whether both arms guess correctly equally often, as the paper has it.

    If nobody, or everybody, was correct the statistic is undefined: p = 1 and a warning.
    EmptyArmError if an arm has no trial. Source: the paper, section 4.4; Pearson (1900), Yates
    (1934).
    """
    correction = "with Yates's continuity correction" if yates else "without continuity correction"
    return _independence(
        table,
        symbol="chi2",
        method=f"Pearson's chi-square {correction}, on trials",
        correction=yates,
        lambda_="pearson",
    )


def g_test(table: TwoByTwo) -> ChiSquare:
    """Likelihood-ratio test of the same, with the same contract. Source: Wilks (1938)."""
    return _independence(
        table,
        symbol="G2",
        method="likelihood-ratio chi-square (G test), on trials",
        correction=False,
        lambda_="log-likelihood",
    )


def fisher_exact(table: TwoByTwo) -> FisherExact:
    """Fisher's exact test, two-sided, with the conditional estimate of the odds ratio.

    The estimate is None where it would be infinite or undefined. It has no interval here: the
    exact one takes minutes to find for a million trials. EmptyArmError if an arm has no trial.
    Source: Fisher (1935).
    """
    from scipy.stats import contingency
    from scipy.stats import fisher_exact as fisher

    table.require_both_arms()
    ratio = float(contingency.odds_ratio(table.counts, kind="conditional").statistic)
    return FisherExact(
        estimate=ratio if np.isfinite(ratio) else None,
        null=1.0,
        unit="odds ratio",
        p=float(fisher(table.counts).pvalue),
        n=table.n,
        n_missing=table.n_missing,
        method="Fisher's exact test, two-sided; conditional odds ratio, on trials",
        source='scipy.stats.fisher_exact, scipy.stats.contingency.odds_ratio(kind="conditional")',
        warnings=_warnings(table, zero_cell=not np.isfinite(ratio)),
    )


def risk_difference(table: TwoByTwo) -> TestResult:
    """Share correct in the treatment arm minus that in the reference arm, -1 to 1.

    EmptyArmError if an arm has no trial. Source: Newcombe (1998), method 10.
    """
    from statsmodels.stats.proportion import confint_proportions_2indep

    treatment, reference = table.arms
    low, high = confint_proportions_2indep(
        treatment.count, treatment.n, reference.count, reference.n, method="newcomb"
    )
    return TestResult(
        estimate=treatment.share - reference.share,
        low=float(low),
        high=float(high),
        null=0.0,
        unit="share",
        n=table.n,
        n_missing=table.n_missing,
        method="difference of shares with Newcombe's hybrid score interval, 95 %, on trials",
        source='statsmodels.stats.proportion.confint_proportions_2indep(method="newcomb")',
    )


def odds_ratio(table: TwoByTwo) -> OddsRatio:
    """Odds ratio with Woolf's interval; a half is added to all counts if one of them is 0.

    Undefined, with a warning, if nobody or everybody was correct. EmptyArmError if an arm has no
    trial. Source: Woolf (1955); Haldane (1956), Anscombe (1956).
    """
    from statsmodels.stats.contingency_tables import Table2x2

    table.require_both_arms()
    zero_cell = bool((table.counts == 0).any())
    estimate = low = high = None
    if not table.is_degenerate:
        # statsmodels' own remedy raises only the zero
        counts = Table2x2(table.counts + 0.5 * zero_cell, shift_zeros=False)
        estimate = float(counts.oddsratio)
        low, high = map(float, counts.oddsratio_confint())
    return OddsRatio(
        estimate=estimate,
        low=low,
        high=high,
        null=1.0,
        unit="odds ratio",
        n=table.n,
        n_missing=table.n_missing,
        method="odds ratio with Woolf's interval, 95 %, on trials"
        + ("; Haldane-Anscombe: a half added to each count" if zero_cell else ""),
        source="statsmodels.stats.contingency_tables.Table2x2.oddsratio_confint",
        warnings=_warnings(table, zero_cell),
        sample=None if zero_cell else estimate,
    )


def _independence(
    table: TwoByTwo,
    *,
    symbol: str,
    method: str,
    correction: bool,
    lambda_: Literal["pearson", "log-likelihood"],
) -> ChiSquare:
    from scipy import stats

    table.require_both_arms()
    phi = statistic = None
    p, min_expected = 1.0, 0.0
    if not table.is_degenerate:
        found = stats.chi2_contingency(table.counts, correction=correction, lambda_=lambda_)
        statistic, p = float(found.statistic), float(found.pvalue)
        phi = _phi(table)
        min_expected = float(found.expected_freq.min())
    return ChiSquare(
        estimate=phi,
        null=0.0,
        unit="phi",
        symbol=symbol,
        statistic=statistic,
        df=1,
        p=p,
        n=table.n,
        n_missing=table.n_missing,
        method=method,
        source=f'scipy.stats.chi2_contingency(correction={correction}, lambda_="{lambda_}")',
        warnings=_warnings(table),
        min_expected=min_expected,
    )


def _phi(table: TwoByTwo) -> float:
    """Correlation of arm and correctness."""
    counts = table.counts.astype(np.float64)
    margins = np.concatenate([counts.sum(axis=0), counts.sum(axis=1)])
    (a, b), (c, d) = counts
    return float((a * d - b * c) / np.sqrt(margins).prod())


def _warnings(table: TwoByTwo, zero_cell: bool = False) -> tuple[str, ...]:
    if table.is_degenerate:
        return (DEGENERATE_MARGIN,)
    return (ZERO_CELL,) if zero_cell else ()
