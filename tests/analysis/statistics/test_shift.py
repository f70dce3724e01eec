"""The shift between two arms and its interval, against scipy's Mann-Whitney test."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis.statistics.ranks import hodges_lehmann

RATINGS = st.lists(st.integers(1, 7), min_size=1, max_size=30)


@given(RATINGS, RATINGS)
def test_the_shift_is_the_median_of_all_differences(x, y):
    differences = np.subtract.outer(x, y)
    assert hodges_lehmann(x, y).estimate == np.median(differences)


@given(RATINGS, RATINGS)
def test_swapping_the_arms_mirrors_the_shift(x, y):
    one, other = hodges_lehmann(x, y), hodges_lehmann(y, x)
    assert one.estimate == -(other.estimate or 0)
    if one.low is not None and other.high is not None:
        assert one.low == -other.high


@pytest.mark.parametrize(
    ("n", "method", "moved"), [(12, "exact", 0.0), (60, "asymptotic", 0.0), (60, "asymptotic", 0.8)]
)
def test_the_interval_holds_the_shifts_that_a_mann_whitney_test_does_not_reject(n, method, moved):
    rng = np.random.default_rng(n)
    x, y = rng.normal(moved, 1, n), rng.normal(0, 2, n - 3)
    found = hodges_lehmann(x, y)
    assert found.low is not None
    assert found.high is not None
    assert method in found.method
    for bound, inwards in ((found.low, 1e-6), (found.high, -1e-6)):
        inside, outside = (
            stats.mannwhitneyu(x - shift, y, use_continuity=False, method=method).pvalue
            for shift in (bound + inwards, bound - inwards)
        )
        assert outside < 0.05 <= inside


@pytest.mark.parametrize("seed", [0, 2, 3, 4, 5])
def test_with_ties_the_interval_holds_the_shifts_between_levels_that_are_not_rejected(seed):
    x, y = np.random.default_rng(seed).integers(1, 8, size=(2, 60)) * 1.0
    y = np.minimum(y + seed % 3, 7)
    found = hodges_lehmann(x, y)
    assert found.low is not None
    assert found.high is not None
    between = np.arange(-6.5, 7)
    kept = [
        shift
        for shift in between
        if stats.mannwhitneyu(x - shift, y, use_continuity=False, method="asymptotic").pvalue > 0.05
    ]
    assert kept == [shift for shift in between if found.low < shift < found.high]


@given(RATINGS, RATINGS)
def test_the_interval_of_ratings_is_a_range_that_holds_0_only_if_the_test_does_not_reject_it(x, y):
    found = hodges_lehmann(x, y)
    if "coarse_values" in found.warnings:
        assert (found.low, found.high) == (None, None)
    if found.low is not None and found.high is not None and not found.warnings:
        assert found.low < found.high
        if found.low <= 0 <= found.high:
            p = stats.mannwhitneyu(x, y, use_continuity=False, method="asymptotic").pvalue
            assert p >= 0.05


@pytest.mark.parametrize("shift", [0, 3])
def test_ratings_too_coarse_for_an_interval_of_the_shift_get_none_but_a_warning(shift):
    """Both limits would be the shift itself."""
    x, y = np.repeat([5, 6, 7], [6, 84, 30]), np.repeat([5, 6, 7], [30, 84, 6])
    found = hodges_lehmann(x + shift, y)
    assert (found.estimate, found.low, found.high) == (shift, None, None)
    assert found.warnings == ("coarse_values",)


def test_without_ties_the_exact_interval_stays_where_only_the_asymptotic_test_rejects_0():
    x, y = [5, 6.1, 7.3, 8.2], [1, 2, 3, 5.5]
    tests = (stats.mannwhitneyu(x, y, False, method=how).pvalue for how in ("exact", "asymptotic"))
    assert [p < 0.05 for p in tests] == [False, True]
    found = hodges_lehmann(x, y)
    assert (found.low, found.warnings) == (-0.5, ())
    assert found.high == pytest.approx(7.2)


def test_the_papers_ratings_have_no_interval_of_the_shift(golden):
    """Its limits would be 0 and 0, and the test rejects that shift: p = .001."""
    levels, *counts = (
        golden("paper_confidence_counts")["input"][name]
        for name in ("levels", "x_counts", "y_counts")
    )
    x, y = (np.repeat(levels, each) for each in counts)
    found = hodges_lehmann(x, y)
    assert (found.estimate, found.low, found.warnings) == (0, None, ("coarse_values",))
