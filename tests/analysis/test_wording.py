"""Numbers as they are printed."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.statistics.normality import normality
from analysis.statistics.ranks import mann_whitney
from analysis.statistics.two_by_two import TwoByTwo, chi_square
from analysis.wording import (
    chi_square_apa,
    format_alpha,
    format_p,
    format_u,
    mann_whitney_apa,
    normality_apa,
    percent,
    without_zero,
    words_of_test,
)


def test_golden_apa_format(golden):
    case = golden("apa_format")
    assert [format_p(p) for p in case["input"]] == case["expected"]


@given(st.floats(0, 1))
def test_a_printed_p_never_says_zero_and_never_crosses_alpha(p):
    printed = format_p(p)
    assert printed != "p = .000"
    if printed.startswith("p = "):
        assert (float(printed.removeprefix("p = ")) < 0.05) == (p < 0.05)


@given(st.floats(0, 1), st.sampled_from([0.001, 0.005, 0.01, 0.025, 0.05, 0.1]))
def test_a_printed_p_falls_on_its_side_of_the_plans_alpha(p, alpha):
    printed = format_p(p, alpha=alpha)
    if printed.startswith("p = "):
        assert (float(printed.removeprefix("p = ")) < alpha) == (p < alpha)


@pytest.mark.parametrize(
    ("p", "alpha", "printed"),
    [
        (0.0098, 0.01, "p = .0098"),
        (0.0248, 0.025, "p = .0248"),
        (0.0248, 0.01, "p = .025"),
        (0.0497, 0.01, "p = .0497"),
    ],
)
def test_digits_are_added_next_to_the_plans_alpha_and_that_of_intervals_only(p, alpha, printed):
    assert format_p(p, alpha=alpha) == printed


@pytest.mark.parametrize(("alpha", "printed"), [(0.05, ".05"), (0.005, ".005"), (0.1, ".1")])
def test_alpha_is_printed_with_all_its_decimals(alpha, printed):
    assert format_alpha(alpha) == printed


def test_a_p_at_the_end_of_a_table_is_printed_as_a_bound():
    assert format_p(0.01, "<=") == "p <= .010"


@pytest.mark.parametrize(
    ("value", "printed"), [(0.18, ".180"), (-0.302, "-.302"), (1.0, "1.000"), (0.0, ".000")]
)
def test_numbers_up_to_one_have_no_leading_zero(value, printed):
    assert without_zero(value, 3) == printed


def test_a_u_keeps_the_half_of_a_tie():
    assert (format_u(177976.0), format_u(19.5)) == ("177976", "19.5")


def test_percentages_have_one_decimal():
    assert percent(832 / 980) == "84.9 %"


def test_chi_square_prints_in_one_line():
    line = chi_square_apa(chi_square(TwoByTwo(832, 148, 362, 158)))
    assert line == "chi2(1) = 48.864, p < .001, N = 1500, phi = .180"


def test_an_undefined_chi_square_prints_na():
    line = chi_square_apa(chi_square(TwoByTwo(3, 0, 4, 0)))
    assert line == "chi2(1) = NA, p > .999, N = 7, phi = NA"


def test_mann_whitney_prints_both_us():
    line = mann_whitney_apa(mann_whitney([3, 4, 5], [1, 2]))
    assert line.startswith("U = 0, p = .083, z = 1.73, n = 3 and 2, rank-biserial r = 1.000")
    assert "U of the treatment = 6" in line


def test_a_z_next_to_0_has_no_sign():
    ranks = list(range(100))
    assert ", z = 0.00, " in mann_whitney_apa(mann_whitney(ranks, [*ranks[:-1], 99.5]))


def test_an_undefined_normality_says_so():
    assert normality_apa(normality([1.0])) == "Shapiro-Wilk: not defined, n = 1"


def test_normality_prints_its_statistic():
    assert normality_apa(normality([1.0, 2.0, 3.0])).startswith("Shapiro-Wilk: W = 1.0000, p ")


@pytest.mark.parametrize(
    ("test", "words"),
    [
        ("two_way_difference", "two-way difference"),
        ("clustered_auc", "clustered AUC"),
        ("two_way_cox", "two-way Cox"),
    ],
)
def test_tests_are_named_in_words(test, words):
    assert words_of_test(test) == words
