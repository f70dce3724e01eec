"""Intervals of shares and means solve their equations."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis.statistics.estimates import mean, share


@given(st.integers(0, 300), st.integers(1, 300))
def test_wilsons_interval_solves_its_equation(count, more):
    n = count + more
    found = share(count, n)
    z = stats.norm.ppf(0.975)
    for bound in (found.low, found.high):
        gap = abs(found.share - bound)
        assert gap == pytest.approx(z * math.sqrt(bound * (1 - bound) / n), abs=1e-7)


def test_the_interval_of_a_mean_is_students():
    values = [12.1, 14.3, 9.8, 11.2, 15.7]
    found = mean([*values, float("nan")], "s")
    expected = stats.ttest_1samp(values, 0).confidence_interval(0.95)
    assert (found.low, found.high) == pytest.approx(tuple(expected))
    assert (found.n, found.n_missing, found.median) == (5, 1, 12.1)
    assert (found.minimum, found.maximum) == (9.8, 15.7)


def test_a_single_value_has_a_mean_and_no_interval():
    found = mean([4.0], "s")
    assert (found.mean, found.sd, found.low, found.high) == (4.0, None, None, None)
