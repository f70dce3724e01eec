"""Which 2x2 tables can have given the figures that a paper prints?

A printed figure is an interval: 48.864 is anything from 48.8635 to 48.8645. Every table of n
trials is tried whose two shares and chi-square lie in the intervals printed.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .errors import AnalysisError
from .statistics.two_by_two import TwoByTwo

Counts = NDArray[np.int64]

LARGEST_N = 1_000_000
MOST_CANDIDATES = 200_000_000
"""As many tables as are tried in about half a minute."""
_BLOCK = 2_000_000
_EXACT = 1e-12


@dataclass(frozen=True)
class Printed:
    """A figure as printed, and the interval of what rounds to it: (units -+ 1/2) / scale."""

    text: str
    units: int
    scale: int

    @property
    def low(self) -> float:
        """Smallest number that prints so; both ends belong, as papers round halves either way."""
        return (2 * self.units - 1) / (2 * self.scale)

    @property
    def high(self) -> float:
        """Largest number that prints so."""
        return (2 * self.units + 1) / (2 * self.scale)


@dataclass(frozen=True)
class Figures:
    """What is printed: n trials, share correct in treatment and reference arm, chi-square.

    With `trials_each`, arms consist of whole participants with that many trials. `yates`: the
    chi-square is the one with continuity correction.
    """

    chi2: Printed
    n: int
    treatment: Printed
    reference: Printed
    trials_each: int | None = None
    yates: bool = False

    def __post_init__(self) -> None:
        if not 2 <= self.n <= LARGEST_N:
            raise AnalysisError(f"n: expected 2 to {LARGEST_N:,} trials, got {self.n:,}")
        for share in (self.treatment, self.reference):
            if share.units > share.scale:
                raise AnalysisError(f"share correct: expected 0 to 1, as in .85, got {share.text}")
        if self.trials_each is not None and (self.trials_each < 1 or self.n % self.trials_each):
            raise AnalysisError(
                f"trials per participant: expected a divisor of n = {self.n}, "
                f"got {self.trials_each}"
            )


@dataclass(frozen=True)
class Reconstructed:
    """A table that prints the figures, with its chi-square on one degree of freedom, and p."""

    table: TwoByTwo
    chi2: float
    p: float


class _Arms(NamedTuple):
    """Candidates by the treatment arm's size, shape (K,): each arm's n, fewest correct, choices."""

    n: Counts
    treatment_fewest: Counts
    treatment_choices: Counts
    reference_fewest: Counts
    reference_choices: Counts


def printed(name: str, text: str) -> Printed:
    """Read a figure with its digits, as in ".70", which is .695 to .705; AnalysisError if none."""
    refusal = f"{name}: expected a number from 0 as it is printed, got {text!r}"
    try:
        number = Decimal(text)
        digits = -int(number.as_tuple().exponent)
    except (InvalidOperation, ValueError) as error:
        raise AnalysisError(refusal) from error
    if not 0 <= digits <= 9 or not 0 <= number < 10**6:
        raise AnalysisError(refusal)
    return Printed(text, int(number.scaleb(digits)), 10**digits)


def reconstruct(figures: Figures) -> tuple[Reconstructed, ...]:
    """Find every table that prints the figures, ordered by the size of the treatment arm.

    AnalysisError if the shares leave more tables to try than `MOST_CANDIDATES`.
    """
    arms = _arms(figures)
    sizes = arms.treatment_choices * arms.reference_choices
    candidates = int(sizes.sum())
    if candidates > MOST_CANDIDATES:
        raise AnalysisError(
            f"expected at most {MOST_CANDIDATES:,} tables to try, got {candidates:,}: give the "
            "shares with more digits, or the trials per participant"
        )
    block = np.cumsum(sizes) // _BLOCK
    cuts = np.flatnonzero(np.diff(block)) + 1
    parts = zip(*(np.split(each, cuts) for each in arms), strict=True)
    return tuple(found for part in parts for found in _found(_Arms(*part), figures))


def _arms(figures: Figures) -> _Arms:
    step = figures.trials_each or 1
    n = np.arange(step, figures.n, step, dtype=np.int64)
    return _Arms(
        n,
        *_choices(n, figures.treatment),
        *_choices(figures.n - n, figures.reference),
    )


def _choices(n: Counts, share: Printed) -> tuple[Counts, Counts]:
    """Fewest correct of n that print the share, and how many counts do; in whole numbers."""
    fewest = np.maximum(-(-n * (2 * share.units - 1) // (2 * share.scale)), 0)
    most = np.minimum(n * (2 * share.units + 1) // (2 * share.scale), n)
    return fewest, np.maximum(most - fewest + 1, 0)


def _found(arms: _Arms, figures: Figures) -> list[Reconstructed]:
    """Try all tables of some arm sizes at once."""
    from scipy import stats

    sizes = arms.treatment_choices * arms.reference_choices
    which = np.repeat(np.arange(len(sizes)), sizes)
    rank = np.arange(len(which)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    n = arms.n[which]
    of_treatment, of_reference = np.divmod(rank, arms.reference_choices[which])
    treatment = arms.treatment_fewest[which] + of_treatment
    reference = arms.reference_fewest[which] + of_reference
    chi2 = _chi_square(treatment, n, reference, figures.n - n, figures.yates)
    fits = (chi2 >= figures.chi2.low * (1 - _EXACT)) & (chi2 <= figures.chi2.high * (1 + _EXACT))
    p = stats.chi2.sf(chi2[fits], 1).tolist()
    rows = zip(*(each[fits].tolist() for each in (treatment, n, reference, chi2)), p, strict=True)
    return [
        Reconstructed(TwoByTwo(a, size - a, b, figures.n - size - b), *statistic)
        for a, size, b, *statistic in rows
    ]


def _chi_square(
    treatment: Counts, n_treatment: Counts, reference: Counts, n_reference: Counts, yates: bool
) -> NDArray[np.float64]:
    """Chi-square of each table, NaN where nobody or everybody was correct."""
    n = n_treatment + n_reference
    correct = treatment + reference
    apart = np.abs(treatment * n_reference - reference * n_treatment).astype(np.float64)
    if yates:
        apart = np.maximum(apart - n / 2, 0)
    margins = n_treatment * n_reference * (correct * (n - correct)).astype(np.float64)
    chi2 = np.full(len(margins), np.nan)
    np.divide(n * apart**2, margins, out=chi2, where=margins > 0)
    return chi2
