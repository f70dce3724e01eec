"""Two one-sided tests against R, and their interval against their verdict."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.statistics.equivalence import two_one_sided
from analysis.statistics.inference import student, undefined
from analysis.statistics.result import TestResult


def a_result(estimate, se, df, null=0.0, unit="share"):
    inference = student(estimate, null, se**2, df)
    return TestResult(**inference, unit=unit, n=99, n_missing=0, method="a test", source="a source")


def test_the_ps_and_the_interval_are_those_of_r():
    """R 4.2.2, with d = .05 and a = .05.

    pt((.012 + d) / .02, 31.5, lower.tail = FALSE); pt((.012 - d) / .02, 31.5);
    .012 + c(-1, 1) * qt(1 - a, 31.5) * .02
    """
    found = two_one_sided(a_result(0.012, 0.02, 31.5), 0.05, 0.05)
    assert found is not None
    assert found.p_below == pytest.approx(0.00202841440356, abs=1e-12)
    assert found.p_above == found.p == pytest.approx(0.0333103456665, abs=1e-12)
    assert (found.low, found.high) == pytest.approx((-0.0218938088702, 0.0458938088702), abs=1e-12)
    assert (found.excluded, found.level) == (True, 0.9)


def test_an_auc_is_set_against_its_distance_from_a_half():
    share = two_one_sided(a_result(0.012, 0.02, 31.5), 0.05, 0.05)
    auc = two_one_sided(a_result(0.512, 0.02, 31.5, 0.5, "probability"), 0.05, 0.05)
    assert share is not None
    assert auc is not None
    assert (auc.p_below, auc.p_above) == pytest.approx((share.p_below, share.p_above))
    assert auc.low == pytest.approx(0.5 + share.low)


@given(
    st.floats(-0.3, 0.3), st.floats(0.005, 0.2), st.floats(2, 200), st.sampled_from([0.01, 0.05])
)
def test_an_effect_is_excluded_if_the_interval_lies_within_it(estimate, se, df, alpha):
    found = two_one_sided(a_result(estimate, se, df), 0.05, alpha)
    assert found is not None
    assert found.level == pytest.approx(1 - 2 * alpha)
    nearest = min(found.low + 0.05, 0.05 - found.high)
    if abs(nearest) > 1e-9:
        assert found.excluded == (nearest > 0)


def test_a_p_that_is_alpha_excludes_nothing():
    test = a_result(0.012, 0.02, 31.5)
    found = two_one_sided(test, 0.05, 0.05)
    assert found is not None
    p = found.p
    for alpha, excluded in ((p, False), (math.nextafter(p, 1), True)):
        found = two_one_sided(test, 0.05, alpha)
        assert found is not None
        assert (found.p, found.excluded) == (p, excluded)


def test_swapping_the_arms_swaps_the_sides():
    one, other = (two_one_sided(a_result(at, 0.02, 9), 0.05, 0.05) for at in (0.01, -0.01))
    assert one is not None
    assert other is not None
    assert (one.p_below, one.p_above) == pytest.approx((other.p_above, other.p_below))


def test_without_a_standard_error_nothing_is_a_result():
    nothing = TestResult(
        **undefined(0.1, 0.0), unit="share", n=9, n_missing=0, method="a test", source="a source"
    )
    assert two_one_sided(nothing, 0.05, 0.05) is None
