"""Two arms compared by ranks.

These tests treat values as independent. On trials that is the paper's choice; it overstates
certainty, because trials of one participant, and trials of one scenario, resemble each other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..errors import EmptyArmError
from . import subset_sums
from .codes import COARSE_VALUES, CONSTANT_OUTCOME, TOO_FEW_VALUES
from .estimates import LEVEL, Values, without_missing
from .inference import student, undefined
from .influence import of_auc
from .outcome import Numbers, Outcome
from .pairwise import Pairwise
from .result import TestResult

_EXACT_BELOW = 50
"""Values per arm from which on the normal approximation serves: R's wilcox.test has the same."""


@dataclass(frozen=True, kw_only=True)
class MannWhitney(TestResult):
    """Two-sided Mann-Whitney test; the estimate is the AUC.

    `u_treatment` counts the pairs in which the treatment arm's value is larger, ties half; the
    AUC is their share, `rank_biserial` = 2 AUC - 1. The statistic is z, None if all values are
    equal, and U where `p` is exact; `sd` is U's under the null hypothesis. An asymptotic `p` is
    with tie correction and without, `p_continuity` with continuity correction; `p_exact` also holds
    with ties, None if an arm has 50 values or more.
    """

    p: float
    p_continuity: float
    p_exact: float | None
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
    no value. `of` names what has the values. The AUC's interval is brunner_munzel's. Source: the
    paper, section 4.4; Mann and Whitney (1947); exact p as R's exactRankTests::wilcox.exact.
    """
    from scipy import stats

    x, y, n_missing = _present(treatment, reference, measure)
    pairs = len(x) * len(y)
    sd = _sd_of_u(x, y)
    u, p, p_continuity, z = pairs / 2, 1.0, 1.0, None
    if sd > 0:
        result = stats.mannwhitneyu(x, y, use_continuity=False, method="asymptotic")
        u, p = float(result.statistic), float(result.pvalue)
        z = (u - pairs / 2) / sd
        p_continuity = min(1.0, 2 * float(stats.norm.sf((abs(u - pairs / 2) - 0.5) / sd)))
    return MannWhitney(
        estimate=u / pairs,
        null=0.5,
        unit="probability",
        symbol="z",
        statistic=z,
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
        p_continuity=p_continuity,
        p_exact=_p_exact(x, y),
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


def mann_whitney_exact_if_few(
    treatment: Values, reference: Values, measure: str = "value", of: str = "trials"
) -> MannWhitney:
    """Test the same, exactly where each arm has fewer than 50 values and no two are equal.

    `method` says which it was; the statistic of the exact test is the treatment's U. All else is as
    in `mann_whitney`. Source: as R's wilcox.test, which chooses by the same rule.
    """
    from scipy import stats

    test = mann_whitney(treatment, reference, measure, of)
    x, y, _ = _present(treatment, reference, measure)
    if not _is_small_and_untied(x, y):
        return test
    return replace(
        test,
        symbol="U",
        statistic=test.u_treatment,
        p=float(stats.mannwhitneyu(x, y, method="exact").pvalue),
        method=f"Mann-Whitney, two-sided, exact, on {of}, few and without ties",
        source='scipy.stats.mannwhitneyu(method="exact")',
    )


def brunner_munzel(
    treatment: Values, reference: Values, measure: str = "value", of: str = "trials"
) -> TestResult:
    """Test the AUC, the probability of a larger value in the treatment arm, without equal spreads.

    Its t is positive for larger values in the treatment arm (scipy's and R's are the other way
    round); without variance, or with one value in an arm, undefined with a warning. NaN is
    missing. EmptyArmError, naming `measure`, if an arm has no value. Source: Brunner and Munzel
    (2000), Biometrical Journal 42, 17-25.
    """
    x, y, n_missing = _present(treatment, reference, measure)
    influence = of_auc(_ungrouped(x, y))
    inference = undefined(influence.estimate, 0.5, TOO_FEW_VALUES)
    if min(len(x), len(y)) > 1:
        # scipy.stats.brunnermunzel keeps the variance and the degrees of freedom to itself
        v_x, v_y = (float(h @ h) * len(h) / (len(h) - 1) for h in np.split(influence.h, [len(x)]))
        spread = v_x**2 / (len(x) - 1) + v_y**2 / (len(y) - 1)
        df = (v_x + v_y) ** 2 / spread if spread else 0.0
        inference = student(influence.estimate, 0.5, v_x + v_y, df)
    return TestResult(
        **inference,
        unit="probability",
        n=len(x) + len(y),
        n_missing=n_missing,
        method=f"Brunner-Munzel, t on Satterthwaite's df, on {of}",
        source="Brunner and Munzel (2000), Biometrical Journal 42, 17-25",
        of=of,
    )


def hodges_lehmann(
    treatment: Values, reference: Values, measure: str = "value", unit: str = ""
) -> TestResult:
    """Shift between the arms: the median of all differences treatment - reference, in `unit`.

    The 95 % interval holds the shifts that a Mann-Whitney test does not reject: the exact test
    without ties and below 50 values per arm, else the asymptotic one with the ties within the
    arms, which no shift dissolves. None with a warning where there are too few values, or where
    they are so coarse that the interval would be a single shift or hold 0 though the test rejects
    it. NaN is missing. EmptyArmError, naming `measure`, if an arm has no value. Source: Hodges and
    Lehmann (1963); Bauer (1972), as R's wilcox.test(conf.int = TRUE).
    """
    x, y, n_missing = _present(treatment, reference, measure)
    differences, pairs = Pairwise.of(x, y), len(x) * len(y)
    exact = _is_small_and_untied(x, y)
    first = _exact_rank(len(x), len(y)) if exact else _asymptotic_rank(x, y)
    warnings: tuple[str, ...] = () if np.ptp(np.concatenate([x, y])) else (CONSTANT_OUTCOME,)
    low = high = None
    if first <= 0:
        warnings = (*warnings, TOO_FEW_VALUES)
    else:
        low, high = differences.smallest(first), differences.smallest(pairs + 1 - first)
        if not (exact or warnings) and _is_too_coarse(low, high, x, y):
            low, high, warnings = None, None, (COARSE_VALUES,)
    median = [differences.smallest(rank) for rank in {(pairs + 1) // 2, pairs // 2 + 1}]
    return TestResult(
        estimate=sum(median) / len(median),
        low=low,
        high=high,
        null=0.0,
        unit=unit,
        n=len(x) + len(y),
        n_missing=n_missing,
        method="Hodges-Lehmann shift with the interval of the "
        f"{'exact' if exact else 'asymptotic'} Mann-Whitney test, 95 %, on trials",
        source="Hodges and Lehmann (1963); Bauer (1972), J. Am. Stat. Assoc. 67, 687-690",
        warnings=warnings,
    )


def _present(treatment: Values, reference: Values, measure: str) -> tuple[Numbers, Numbers, int]:
    """Return both arms without their missing values, and how many those were."""
    x, missing_x = without_missing(treatment)
    y, missing_y = without_missing(reference)
    for arm, values in (("treatment", x), ("reference", y)):
        if len(values) == 0:
            raise EmptyArmError(arm, measure)
    return x, y, missing_x + missing_y


def _sd_of_u(x: Numbers, y: Numbers) -> float:
    """Standard deviation of U if the arms do not differ, corrected for ties across the arms."""
    _, ties = np.unique(np.concatenate([x, y]), return_counts=True)
    return _sd(len(x), len(y), ties) if len(ties) > 1 else 0.0


def _sd(n_x: int, n_y: int, *ties: NDArray[np.int64]) -> float:
    """Standard deviation of U; `ties` are the numbers of values that are equal."""
    n = n_x + n_y
    t = np.concatenate(ties).astype(np.float64)
    tie_term = float((t**3 - t).sum()) / (n * (n - 1))
    return math.sqrt(max(0.0, n_x * n_y / 12 * (n + 1 - tie_term)))


def _p_exact(x: Numbers, y: Numbers) -> float | None:
    """Two-sided exact p of the rank sum, given the ties; None where an arm is too large."""
    from scipy import stats

    if not _is_small(x, y):
        return None
    twice = np.rint(2 * stats.rankdata(np.concatenate([x, y]))).astype(np.int64)
    return subset_sums.two_sided_p(twice, np.arange(len(twice)) < len(x))


def _is_small(x: Numbers, y: Numbers) -> bool:
    return max(len(x), len(y)) < _EXACT_BELOW


def _is_small_and_untied(x: Numbers, y: Numbers) -> bool:
    return _is_small(x, y) and len(np.unique(np.concatenate([x, y]))) == len(x) + len(y)


def _exact_rank(n_x: int, n_y: int) -> int:
    """Rank of the difference at which the interval begins, 0 if even all differences are too few.

    It is the 2.5 % quantile of U if the arms do not differ and nothing is tied.
    """
    rank_sums, counts = subset_sums.distribution(np.arange(n_x + n_y), n_x)
    quantile = np.searchsorted(np.cumsum(counts) / counts.sum(), (1 - LEVEL) / 2)
    return int(rank_sums[quantile]) - n_x * (n_x - 1) // 2


def _asymptotic_rank(x: Numbers, y: Numbers) -> int:
    """The same by the normal approximation, given the ties within the arms; may be below 0."""
    from scipy import stats

    within = (np.unique(each, return_counts=True)[1] for each in (x, y))
    reach = float(stats.norm.ppf((1 + LEVEL) / 2)) * _sd(len(x), len(y), *within)
    return math.ceil(len(x) * len(y) / 2 - reach)


def _is_too_coarse(low: float, high: float, x: Numbers, y: Numbers) -> bool:
    """Whether ties between the arms, which a shift dissolves, belie the interval of the shift."""
    from scipy import stats

    if low == high:
        return True
    if not low <= 0 <= high:
        return False
    unmoved = stats.mannwhitneyu(x, y, use_continuity=False, method="asymptotic")
    return bool(unmoved.pvalue < 1 - LEVEL)


def _ungrouped(x: Numbers, y: Numbers) -> Outcome:
    """Return both arms as one outcome, each value a cluster of its own."""
    there = np.arange(len(x) + len(y))
    return Outcome("", "", np.concatenate([x, y]), there < len(x), there, there)
