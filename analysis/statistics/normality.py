"""How far values are from normal: a description, never used to choose a test."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .codes import CONSTANT_OUTCOME, TOO_FEW_VALUES
from .estimates import Values, without_missing
from .result import TestResult

SHAPIRO_LIMIT = 5_000
"""Above this number of values Shapiro-Wilk's p is no longer accurate."""

_FEWEST = 3


@dataclass(frozen=True, kw_only=True)
class Normality(TestResult):
    """Test of normality; the estimate is the statistic: W (1 if normal) or A2 (0 if normal).

    Both, and `p`, are None if there are too few values or all are equal. `p_relation` is not "="
    where the tables end: Anderson-Darling's p is known between .01 and .15 only.
    """

    p_relation: Literal["=", "<=", ">="] = "="


def normality(values: Values, of: str = "trials") -> Normality:
    """Test with Shapiro-Wilk up to 5,000 values, with Anderson-Darling beyond.

    NaN is missing and left out. Needs three values that are not all equal, else a warning.
    Source: Shapiro and Wilk (1965), Royston (1995); Anderson and Darling (1954).
    """
    present, n_missing = without_missing(values)
    n = len(present)
    statistic = p = None
    relation: Literal["=", "<=", ">="] = "="
    warnings: tuple[str, ...] = ()
    if n < _FEWEST:
        warnings = (TOO_FEW_VALUES,)
    elif np.ptp(present) == 0:
        warnings = (CONSTANT_OUTCOME,)
    elif n <= SHAPIRO_LIMIT:
        statistic, p = _shapiro_wilk(present)
    else:
        statistic, p = _anderson_darling(present)
        relation = "<=" if p <= 0.01 else ">=" if p >= 0.15 else "="
    few = n <= SHAPIRO_LIMIT
    return Normality(
        estimate=statistic,
        null=1.0 if few else 0.0,
        unit="W" if few else "A2",
        symbol="W" if few else "A2",
        statistic=statistic,
        p=p,
        n=n,
        n_missing=n_missing,
        method="Shapiro-Wilk" if few else "Anderson-Darling",
        source="scipy.stats.shapiro" if few else 'scipy.stats.anderson(method="interpolate")',
        of=of,
        warnings=warnings,
        p_relation=relation,
    )


def _shapiro_wilk(values: NDArray[np.float64]) -> tuple[float, float]:
    from scipy import stats

    result = stats.shapiro(values)
    return float(result.statistic), float(result.pvalue)


def _anderson_darling(values: NDArray[np.float64]) -> tuple[float, float]:
    from scipy import stats

    # the stubs misspell the name of the method
    result = stats.anderson(values, method="interpolate")  # type: ignore[call-overload]
    return float(result.statistic), float(result.pvalue)
