"""The 2x2 table against frozen numbers of R, closed forms and its own symmetries."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis import EmptyArmError
from analysis.statistics.two_by_two import TwoByTwo, chi_square
from tests.analysis.statistics.cases import holds

COUNTS = st.integers(0, 200)


def counts(case):
    (a, b), (c, d) = case["input"]["table"]
    return TwoByTwo(a, b, c, d)


@pytest.mark.parametrize("case_id", ["paper_98x52", "newcombe_textbook", "zero_cell"])
def test_golden_two_by_two(golden, case_id):
    """R 4.2.2 stats::chisq.test and prop.test."""
    case = golden(case_id)
    test = chi_square(counts(case))
    treatment, reference = counts(case).arms
    holds(
        case,
        {
            "n1": treatment.n,
            "n2": reference.n,
            "p1": treatment.share,
            "p2": reference.share,
            "chi2": test.statistic,
            "df": test.df,
            "p": test.p,
            "phi": test.estimate,
            "min_expected": test.min_expected,
        },
    )
    for arm, name in ((treatment, "wilson1"), (reference, "wilson2")):
        assert [arm.low, arm.high] == pytest.approx(case["expected"][name], abs=case["tol"])


def test_the_papers_chi_square_prints_as_in_the_paper(golden):
    assert f"{chi_square(counts(golden('paper_98x52'))).statistic:.3f}" == "48.864"


def test_golden_all_correct_has_no_statistic_but_a_warning(golden):
    """R fisher.test and prop.test."""
    case = golden("all_correct")
    test = chi_square(counts(case))
    treatment, reference = counts(case).arms
    holds(case, {"chi2": test.statistic, "p": test.p})
    assert list(test.warnings) == case["expected"]["warnings"]
    assert [treatment.low, treatment.high] == pytest.approx(case["expected"]["wilson1"], abs=1e-6)
    assert [reference.low, reference.high] == pytest.approx(case["expected"]["wilson2"], abs=1e-6)


def test_golden_empty_arm_is_a_structured_error(golden):
    assert golden("empty_arm")["expected"] == {"error": "empty_arm"}
    with pytest.raises(EmptyArmError) as caught:
        chi_square(counts(golden("empty_arm")))
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
