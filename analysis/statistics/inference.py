"""From an estimate and its variance to interval and p."""

from __future__ import annotations

import math
from typing import TypedDict

from .codes import CONSTANT_OUTCOME, NO_VARIATION
from .estimates import LEVEL

FEW = 10
"""Below this many clusters their variance is too uncertain even for Student's t: Cameron, Gelbach
and Miller (2008), Review of Economics and Statistics 90, 414-427."""


class Inference(TypedDict):
    """The fields of a TestResult that follow from an estimate and its variance."""

    estimate: float | None
    null: float
    se: float | None
    low: float | None
    high: float | None
    symbol: str
    statistic: float | None
    df: float | None
    p: float | None
    warnings: tuple[str, ...]


def undefined(
    estimate: float | None, null: float, *warnings: str, p: float | None = None
) -> Inference:
    """Return an estimate of whose uncertainty nothing is known, and `warnings` that say why."""
    return Inference(
        estimate=estimate,
        null=null,
        se=None,
        low=None,
        high=None,
        symbol="t",
        statistic=None,
        df=None,
        p=p,
        warnings=warnings,
    )


def student(estimate: float, null: float, variance: float, df: float, *warnings: str) -> Inference:
    """Test `estimate` against `null` by Student's t; the interval is not cut at natural bounds.

    Without variance nothing is tested: p is 1 where the estimate is the null value, else None.
    """
    from scipy.special import stdtr, stdtrit

    if variance <= 0:
        if math.isclose(estimate, null, abs_tol=1e-12):
            return undefined(estimate, null, *warnings, CONSTANT_OUTCOME, p=1.0)
        return undefined(estimate, null, *warnings, NO_VARIATION)
    se = math.sqrt(variance)
    t = (estimate - null) / se
    half = float(stdtrit(df, (1 + LEVEL) / 2)) * se
    return Inference(
        estimate=estimate,
        null=null,
        se=se,
        low=estimate - half,
        high=estimate + half,
        symbol="t",
        statistic=t,
        df=df,
        p=2 * float(stdtr(df, -abs(t))),
        warnings=warnings,
    )
