"""The 2x2 table against frozen numbers of R, closed forms and its own symmetries."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis import EmptyArmError
from analysis.statistics.two_by_two import (
    TwoByTwo,
    chi_square,
    fisher_exact,
    g_test,
    odds_ratio,
    risk_difference,
)
from tests.analysis.statistics.cases import holds

COUNTS = st.integers(0, 200)
ROWS = st.tuples(COUNTS, COUNTS).filter(any)
TABLES = st.tuples(ROWS, ROWS)


def counts(case):
    (a, b), (c, d) = case["input"]["table"]
    return TwoByTwo(a, b, c, d)


@pytest.mark.parametrize("case_id", ["paper_98x52", "newcombe_textbook", "zero_cell"])
def test_golden_two_by_two(golden, case_id):
    """R 4.2.2 stats::chisq.test, fisher.test and prop.test; Newcombe's method 10 by formula."""
    case = golden(case_id)
    table = counts(case)
    treatment, reference = table.arms
    pearson, yates, g = chi_square(table), chi_square(table, yates=True), g_test(table)
    fisher, ratio, difference = fisher_exact(table), odds_ratio(table), risk_difference(table)
    found = {
        "n1": treatment.n,
        "n2": reference.n,
        "p1": treatment.share,
        "p2": reference.share,
        "wilson1": [treatment.low, treatment.high],
        "wilson2": [reference.low, reference.high],
        "chi2": pearson.statistic,
        "df": pearson.df,
        "p": pearson.p,
        "phi": pearson.estimate,
        "min_expected": pearson.min_expected,
        "chi2_yates": yates.statistic,
        "p_yates": yates.p,
        "g2": g.statistic,
        "p_g2": g.p,
        "fisher_p": fisher.p,
        "fisher_or_cond_mle": "inf" if fisher.estimate is None else fisher.estimate,
        "or": ratio.sample,
        "or_haldane": ratio.warnings == ("zero_cell",),
        "or_for_ci": ratio.estimate,
        "or_ci_woolf": [ratio.low, ratio.high],
        "rd": difference.estimate,
        "rd_ci_newcombe": [difference.low, difference.high],
    }
    assert found.keys() == case["expected"].keys()
    holds(case, found)
    for name in ("p", "p_yates", "p_g2", "fisher_p"):
        assert found[name] == pytest.approx(case["expected"][name], rel=case["tol"]), name


def test_the_papers_chi_square_prints_as_in_the_paper(golden):
    assert f"{chi_square(counts(golden('paper_98x52'))).statistic:.3f}" == "48.864"


def test_golden_all_correct_has_no_statistic_but_a_warning(golden):
    """R fisher.test and prop.test."""
    case = golden("all_correct")
    table = counts(case)
    treatment, reference = table.arms
    test, difference = chi_square(table), risk_difference(table)
    found = {
        "chi2": test.statistic,
        "p": test.p,
        "fisher_p": fisher_exact(table).p,
        "rd": difference.estimate,
        "rd_ci_newcombe": [difference.low, difference.high],
        "wilson1": [treatment.low, treatment.high],
        "wilson2": [reference.low, reference.high],
        "or": odds_ratio(table).estimate,
    }
    assert found.keys() | {"warnings"} == case["expected"].keys()
    holds(case, found)
    assert list(test.warnings) == case["expected"]["warnings"]
    for each in (g_test(table), fisher_exact(table), odds_ratio(table)):
        assert (each.estimate, each.warnings) == (None, ("degenerate_margin",))


@pytest.mark.parametrize("method", [chi_square, g_test, fisher_exact, risk_difference, odds_ratio])
def test_golden_empty_arm_is_a_structured_error(golden, method):
    assert golden("empty_arm")["expected"] == {"error": "empty_arm"}
    with pytest.raises(EmptyArmError) as caught:
        method(counts(golden("empty_arm")))
    assert (caught.value.arm, caught.value.measure) == ("reference", "guess")


@given(COUNTS, COUNTS, COUNTS, COUNTS)
def test_chi_square_is_the_textbook_formula(a, b, c, d):
    if a + b == 0 or c + d == 0:
        return
    test = chi_square(TwoByTwo(a, b, c, d))
    if a + c == 0 or b + d == 0:
        assert (test.statistic, test.p) == (None, 1.0)
        return
    n = a + b + c + d
    chi2 = n * (a * d - b * c) ** 2 / ((a + b) * (c + d) * (a + c) * (b + d))
    assert test.statistic == pytest.approx(chi2, abs=1e-9)
    assert test.p == pytest.approx(math.erfc(math.sqrt(chi2 / 2)), abs=1e-12)
    assert test.estimate == pytest.approx(
        (a * d - b * c) / math.sqrt((a + b) * (c + d) * (a + c) * (b + d)), abs=1e-9
    )


def interval(found):
    assert found.low is not None
    assert found.high is not None
    return found.low, found.high


@given(TABLES)
def test_swapping_the_arms_mirrors_estimates_and_keeps_p(table):
    (a, b), (c, d) = table
    one, other = TwoByTwo(a, b, c, d), TwoByTwo(c, d, a, b)
    pearson, mirrored = chi_square(one), chi_square(other)
    assert pearson.p == pytest.approx(mirrored.p)
    assert fisher_exact(one).p == pytest.approx(fisher_exact(other).p)
    low, high = interval(risk_difference(one))
    assert interval(risk_difference(other)) == pytest.approx((-high, -low))
    if pearson.estimate is not None and mirrored.estimate is not None:
        assert pearson.estimate == pytest.approx(-mirrored.estimate)
        low, high = interval(odds_ratio(one))
        assert interval(odds_ratio(other)) == pytest.approx((1 / high, 1 / low))


@given(TABLES)
def test_newcombes_interval_is_made_of_wilsons(table):
    (a, b), (c, d) = table
    one, other = TwoByTwo(a, b, c, d).arms
    difference = one.share - other.share
    below = math.hypot(one.share - one.low, other.high - other.share)
    above = math.hypot(one.high - one.share, other.share - other.low)
    found = risk_difference(TwoByTwo(a, b, c, d))
    assert found.estimate == difference
    assert interval(found) == pytest.approx((difference - below, difference + above), abs=1e-9)


@given(TABLES)
def test_woolfs_interval_is_symmetric_on_the_log_scale(table):
    (a, b), (c, d) = table
    found = odds_ratio(TwoByTwo(a, b, c, d))
    if found.estimate is not None:
        cells = [each + (0.5 if 0 in (a, b, c, d) else 0) for each in (a, b, c, d)]
        ratio = cells[0] * cells[3] / (cells[1] * cells[2])
        factor = math.exp(stats.norm.ppf(0.975) * math.sqrt(sum(1 / each for each in cells)))
        assert found.estimate == pytest.approx(ratio)
        assert interval(found) == pytest.approx((ratio / factor, ratio * factor))


@pytest.mark.parametrize("method", [chi_square, g_test, fisher_exact, risk_difference, odds_ratio])
def test_missing_guesses_are_counted(method):
    found = method(TwoByTwo(5, 3, 2, 6, n_missing_treatment=4, n_missing_reference=1))
    assert (found.n, found.n_missing) == (16, 5)
