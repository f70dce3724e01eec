"""What every test and estimate returns."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class TestResult:
    """An estimate with its interval and the test of its null value; what is undefined is None.

    `estimate`, `se`, `low`, `high` (95 %) and `null` in `unit`; positive estimates mean more in the
    treatment arm. `statistic` is what `symbol` names (t, z, chi2, F, U, ...) on `df` degrees of
    freedom (a pair for F). `n` counts the trials, or what `of` names, that were used.
    """

    __test__ = False  # not a test of pytest's

    estimate: float | None
    null: float
    unit: str
    n: int
    n_missing: int
    method: str
    source: str
    se: float | None = None
    low: float | None = None
    high: float | None = None
    symbol: str = ""
    statistic: float | None = None
    df: float | tuple[float, float] | None = None
    p: float | None = None
    of: str = "trials"
    warnings: tuple[str, ...] = ()
