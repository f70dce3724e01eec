"""The paper's tests against frozen numbers of R, closed forms and their own symmetries."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis import EmptyArmError, read_dataset
from analysis.as_in_paper import values_of
from analysis.estimates import mean, share
from analysis.paper_tests import TwoByTwo, chi_square, mann_whitney, normality

COUNTS = st.integers(0, 200)
RATINGS = st.lists(st.integers(1, 7), min_size=1, max_size=30)


def counts(case):
    (a, b), (c, d) = case["input"]["table"]
    return TwoByTwo(a, b, c, d)


def holds(case, names):
    """Compare numbers with the case's, within its tolerance; a failure tells the source."""
    for name, value in names.items():
        expected = case["expected"][name]
        wanted = (
            expected if expected is None else pytest.approx(expected, rel=1e-9, abs=case["tol"])
        )
        assert value == wanted, f"{name} of {case['id']}: {case['source']}"


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
            "chi2": test.chi2,
            "df": test.df,
            "p": test.p,
            "phi": test.phi,
            "min_expected": test.min_expected,
        },
    )
    for arm, name in ((treatment, "wilson1"), (reference, "wilson2")):
        assert [arm.low, arm.high] == pytest.approx(case["expected"][name], abs=case["tol"])


def test_the_papers_chi_square_prints_as_in_the_paper(golden):
    assert f"{chi_square(counts(golden('paper_98x52'))).chi2:.3f}" == "48.864"


def test_golden_all_correct_has_no_statistic_but_a_warning(golden):
    """R fisher.test and prop.test."""
    case = golden("all_correct")
    test = chi_square(counts(case))
    treatment, reference = counts(case).arms
    holds(case, {"chi2": test.chi2, "p": test.p})
    assert list(test.warnings) == case["expected"]["warnings"]
    assert [treatment.low, treatment.high] == pytest.approx(case["expected"]["wilson1"], abs=1e-6)
    assert [reference.low, reference.high] == pytest.approx(case["expected"]["wilson2"], abs=1e-6)


def test_golden_empty_arm_is_a_structured_error(golden):
    assert golden("empty_arm")["expected"] == {"error": "empty_arm"}
    with pytest.raises(EmptyArmError) as caught:
        chi_square(counts(golden("empty_arm")))
    assert (caught.value.arm, caught.value.measure) == ("optimal", "guess")


@pytest.mark.parametrize("case_id", ["mw_no_ties", "mw_likert_ties", "mw_all_tied"])
def test_golden_mann_whitney(golden, case_id):
    """R 4.2.2 wilcox.test(correct = FALSE, exact = FALSE)."""
    case = golden(case_id)
    check_ranks(mann_whitney(case["input"]["x"], case["input"]["y"]), case)


def test_golden_mann_whitney_of_the_papers_confidence_counts(golden):
    """R 4.2.2 wilcox.test(correct = FALSE, exact = FALSE)."""
    case = golden("paper_confidence_counts")
    given = case["input"]
    x = np.repeat(given["levels"], given["x_counts"])
    y = np.repeat(given["levels"], given["y_counts"])
    check_ranks(mann_whitney(x, y), case)
    assert mean(x, "").mean == pytest.approx(case["expected"]["mean1"])
    assert mean(y, "").mean == pytest.approx(case["expected"]["mean2"])


def test_golden_mann_whitney_of_the_fixtures_times(golden, paper_fixture):
    """R 4.2.2 wilcox.test(correct = FALSE, exact = FALSE) on synthetic trials."""
    case = golden("paper_time_fixture")
    data = read_dataset(paper_fixture)
    x, y = (values_of(data, arm, "prediction_time_s") for arm in ("polmdp", "optimal"))
    check_ranks(mann_whitney(x, y), case)
    assert mean(x, "s").mean == pytest.approx(case["expected"]["mean1"])
    assert mean(y, "s").mean == pytest.approx(case["expected"]["mean2"])


def check_ranks(test, case):
    names = {
        "n1": test.n_treatment,
        "n2": test.n_reference,
        "n_missing": test.n_missing,
        "u1": test.u_treatment,
        "u2": test.u_reference,
        "u_min": test.u_smaller,
        "sd_tie_corrected": test.sd,
        "z": test.z,
        "p": test.p,
        "auc": test.auc,
        "rank_biserial": test.rank_biserial,
        "median1": test.median_treatment,
        "median2": test.median_reference,
    }
    holds(case, {name: value for name, value in names.items() if name in case["expected"]})
    assert list(test.warnings) == case["expected"].get("warnings", [])


def test_golden_mann_whitney_of_an_empty_arm_is_a_structured_error(golden):
    case = golden("mw_empty")
    assert case["expected"] == {"error": "empty_arm"}
    with pytest.raises(EmptyArmError, match=r"condition optimal: .* confidence, got none"):
        mann_whitney(case["input"]["x"], case["input"]["y"], "confidence")


@given(COUNTS, COUNTS, COUNTS, COUNTS)
def test_chi_square_is_the_textbook_formula(a, b, c, d):
    if a + b == 0 or c + d == 0:
        return
    test = chi_square(TwoByTwo(a, b, c, d))
    if a + c == 0 or b + d == 0:
        assert (test.chi2, test.p) == (None, 1.0)
        return
    n = a + b + c + d
    chi2 = n * (a * d - b * c) ** 2 / ((a + b) * (c + d) * (a + c) * (b + d))
    assert test.chi2 == pytest.approx(chi2, abs=1e-9)
    assert test.p == pytest.approx(math.erfc(math.sqrt(chi2 / 2)), abs=1e-12)
    assert test.phi == pytest.approx(
        (a * d - b * c) / math.sqrt((a + b) * (c + d) * (a + c) * (b + d)), abs=1e-9
    )


@given(RATINGS, RATINGS)
def test_u_counts_the_pairs_that_the_treatment_wins(x, y):
    test = mann_whitney(x, y)
    wins = sum((a > b) + (a == b) / 2 for a in x for b in y)
    assert test.u_treatment == wins
    assert test.auc == pytest.approx(wins / (len(x) * len(y)))


@given(RATINGS, RATINGS)
def test_swapping_the_arms_mirrors_u_and_keeps_p(x, y):
    one, other = mann_whitney(x, y), mann_whitney(y, x)
    assert (one.u_treatment, one.u_reference) == (other.u_reference, other.u_treatment)
    assert one.u_smaller == other.u_smaller
    assert one.p == pytest.approx(other.p)
    assert one.rank_biserial == pytest.approx(-other.rank_biserial)


@given(RATINGS, RATINGS, st.randoms())
def test_the_order_of_values_changes_nothing(x, y, random):
    before = mann_whitney(x, y)
    random.shuffle(x)
    random.shuffle(y)
    assert mann_whitney(x, y) == before


@given(RATINGS, RATINGS)
def test_only_ranks_matter(x, y):
    one, other = mann_whitney(x, y), mann_whitney([v**3 for v in x], [v**3 for v in y])
    assert (one.u_treatment, one.p, one.z) == (other.u_treatment, other.p, other.z)


@given(RATINGS, RATINGS)
def test_p_and_z_tell_the_same(x, y):
    test = mann_whitney(x, y)
    if test.z is not None:
        assert test.p == pytest.approx(math.erfc(abs(test.z) / math.sqrt(2)), abs=1e-9)


def test_missing_values_are_left_out_and_counted():
    nan = float("nan")
    test = mann_whitney([1, nan, 3], [2, nan, nan])
    assert (test.n_treatment, test.n_reference, test.n_missing) == (2, 1, 3)
    assert test.u_treatment == 1


def test_an_arm_of_missing_values_only_is_empty():
    with pytest.raises(EmptyArmError, match="condition polmdp"):
        mann_whitney([float("nan")], [1.0])


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
