"""Normality as a description, against scipy and the textbook's formula."""

import numpy as np
import pytest
from scipy import stats

from analysis.statistics.normality import normality


def test_normality_is_shapiro_wilk_up_to_5000_values():
    values = np.random.default_rng(5).normal(size=5000)
    test = normality(values)
    assert (test.method, test.n) == ("Shapiro-Wilk", 5000)
    assert (test.statistic, test.p) == pytest.approx(tuple(stats.shapiro(values)))


def test_normality_is_anderson_darling_beyond():
    values = np.sort(np.random.default_rng(5).exponential(size=5001))
    test = normality(values)
    n, i = len(values), np.arange(1, len(values) + 1)
    z = stats.norm((values.mean()), values.std(ddof=1))
    a2 = -n - np.mean((2 * i - 1) * (z.logcdf(values) + z.logsf(values[::-1])))
    assert test.method == "Anderson-Darling"
    assert test.statistic == pytest.approx(a2)
    assert (test.p, test.p_relation) == (0.01, "<=")


def test_a_p_beyond_the_end_of_the_tables_is_a_bound():
    evenly = stats.norm.ppf((np.arange(1, 6001) - 0.5) / 6000)
    assert (normality(evenly).p, normality(evenly).p_relation) == (0.15, ">=")


@pytest.mark.parametrize(
    ("values", "warning"), [([1, 2], "too_few_values"), ([7, 7, 7], "constant_outcome")]
)
def test_normality_of_next_to_nothing_is_not_defined(values, warning):
    test = normality([*values, float("nan")])
    assert (test.statistic, test.p, test.n_missing) == (None, None, 1)
    assert test.warnings == (warning,)
