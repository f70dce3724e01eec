"""What a test that shows no difference can exclude: two one-sided tests on its estimate."""

from __future__ import annotations

from dataclasses import dataclass

from .result import TestResult


@dataclass(frozen=True, kw_only=True)
class Equivalence:
    """Whether effects of `smallest_effect` or more, either way from `null`, can be excluded.

    `low` to `high`, of `level` 1 - 2 alpha, lies within `smallest_effect` of `null` exactly if
    `excluded`, which is p < `alpha`; all but p in `unit`. `p_below` and `p_above` test whether the
    effect is that far below `null`, or above it; `p` is the larger.
    """

    smallest_effect: float
    null: float
    unit: str
    alpha: float
    level: float
    low: float
    high: float
    p_below: float
    p_above: float
    p: float
    excluded: bool
    method: str = "two one-sided t tests, on estimate, standard error and df of the primary test"
    source: str = "Schuirmann (1987), Journal of Pharmacokinetics and Biopharmaceutics 15, 657-680"


def two_one_sided(test: TestResult, smallest_effect: float, alpha: float) -> Equivalence | None:
    """Test each way whether an effect of `smallest_effect` > 0, in the test's unit, is excluded.

    `test` is a t test; None where it has no standard error. `alpha`, below .5, is that of either
    one-sided test; since both must reject, also that of a false exclusion. Source: Schuirmann
    (1987).
    """
    from scipy.special import stdtr, stdtrit

    estimate, se, df = test.estimate, test.se, test.df
    if estimate is None or se is None or not isinstance(df, float | int):
        return None
    effect, half = estimate - test.null, float(stdtrit(df, 1 - alpha)) * se
    p_below = float(stdtr(df, -(effect + smallest_effect) / se))
    p_above = float(stdtr(df, (effect - smallest_effect) / se))
    p = max(p_below, p_above)
    return Equivalence(
        smallest_effect=smallest_effect,
        null=test.null,
        unit=test.unit,
        alpha=alpha,
        level=1 - 2 * alpha,
        low=estimate - half,
        high=estimate + half,
        p_below=p_below,
        p_above=p_above,
        p=p,
        excluded=p < alpha,
    )
