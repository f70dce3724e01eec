import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from policies.experiments.paired import holm, mean_interval, paired_test


def drawn(n=25, seed=0):
    return np.random.default_rng(seed).normal(0.4, 1.0, (2, n))


def test_the_interval_is_scipys():
    values, _ = drawn()
    found = mean_interval(values)
    low, high = stats.t.interval(0.95, 24, values.mean(), stats.sem(values))
    assert found.n == 25
    assert [found.mean, found.low, found.high] == pytest.approx([values.mean(), low, high])


def test_few_values_have_no_interval():
    assert mean_interval(np.array([])).n == 0
    one = mean_interval(np.array([2.0]))
    assert (one.n, one.mean) == (1, 2.0)
    assert np.isnan([one.low, one.high]).all()


def test_the_t_test_is_scipys():
    a, b = drawn()
    found, wanted = paired_test(a, b), stats.ttest_rel(a, b)
    assert [found.t, found.p_t] == pytest.approx([wanted.statistic, wanted.pvalue])
    assert found.difference.mean == pytest.approx((a - b).mean())
    assert found.d_z == pytest.approx(wanted.statistic / 5)


def test_ranks_by_hand():
    # Differences 1, -2, 3, 4, 0: ranks 1, 2, 3, 4; positive 8, negative 2.
    found = paired_test(np.array([1.0, 0, 3, 4, 5]), np.array([0.0, 2, 0, 0, 5]))
    assert found.rank_biserial == pytest.approx((8 - 2) / 10)


def test_the_signed_rank_test_is_scipys_two_sided_one():
    a, b = drawn(12)
    assert paired_test(a, b).p_wilcoxon == pytest.approx(
        stats.wilcoxon(a, b, method="approx").pvalue
    )


def test_the_other_way_round_turns_the_signs():
    a, b = drawn()
    one, other = paired_test(a, b), paired_test(b, a)
    assert other.difference.mean == pytest.approx(-one.difference.mean)
    assert other.d_z == pytest.approx(-one.d_z)
    assert other.rank_biserial == pytest.approx(-one.rank_biserial)
    assert other.p_t == pytest.approx(one.p_t)
    assert other.p_wilcoxon == pytest.approx(one.p_wilcoxon)


@pytest.mark.parametrize("n", [0, 1, 5])
def test_nothing_that_differs_shows_no_difference(n):
    found = paired_test(np.ones(n), np.ones(n))
    assert (found.p_t, found.p_wilcoxon) == (1, 1)
    assert np.isnan([found.d_z, found.rank_biserial]).all()


def test_a_constant_difference_is_shown():
    found = paired_test(np.full(8, 3.0), np.full(8, 1.0))
    assert found.d_z == np.inf
    assert found.p_t == 0
    assert found.rank_biserial == 1


def test_holm_by_hand():
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([0.9, 0.8]) == [1, 1]


@given(st.lists(st.floats(0, 1), max_size=12))
def test_holm_is_at_most_bonferroni_and_keeps_the_order(p):
    adjusted = holm(p)
    assert all(q >= each for q, each in zip(adjusted, p, strict=True))
    assert all(q <= min(1, len(p) * each) + 1e-12 for q, each in zip(adjusted, p, strict=True))
    assert [adjusted[i] for i in np.argsort(p, kind="stable")] == sorted(adjusted)
