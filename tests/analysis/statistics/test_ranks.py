"""Comparing by ranks, against frozen numbers of R, closed forms and its own symmetries."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis import EmptyArmError, read_dataset
from analysis.as_in_paper import values_of
from analysis.statistics.estimates import mean
from analysis.statistics.ranks import mann_whitney
from tests.analysis.statistics.cases import holds

RATINGS = st.lists(st.integers(1, 7), min_size=1, max_size=30)


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
        "z": test.statistic,
        "p": test.p,
        "auc": test.estimate,
        "rank_biserial": test.rank_biserial,
        "median1": test.median_treatment,
        "median2": test.median_reference,
    }
    holds(case, {name: value for name, value in names.items() if name in case["expected"]})
    assert list(test.warnings) == case["expected"].get("warnings", [])


def test_golden_mann_whitney_of_an_empty_arm_is_a_structured_error(golden):
    case = golden("mw_empty")
    assert case["expected"] == {"error": "empty_arm"}
    with pytest.raises(EmptyArmError, match=r"condition reference: .* confidence, got none"):
        mann_whitney(case["input"]["x"], case["input"]["y"], "confidence")


@given(RATINGS, RATINGS)
def test_u_counts_the_pairs_that_the_treatment_wins(x, y):
    test = mann_whitney(x, y)
    wins = sum((a > b) + (a == b) / 2 for a in x for b in y)
    assert test.u_treatment == wins
    assert test.estimate == pytest.approx(wins / (len(x) * len(y)))


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
    assert (one.u_treatment, one.p, one.statistic) == (other.u_treatment, other.p, other.statistic)


@given(RATINGS, RATINGS)
def test_p_and_z_tell_the_same(x, y):
    test = mann_whitney(x, y)
    if test.statistic is not None:
        assert test.p == pytest.approx(math.erfc(abs(test.statistic) / math.sqrt(2)), abs=1e-9)


def test_missing_values_are_left_out_and_counted():
    nan = float("nan")
    test = mann_whitney([1, nan, 3], [2, nan, nan])
    assert (test.n_treatment, test.n_reference, test.n_missing) == (2, 1, 3)
    assert test.u_treatment == 1


def test_an_arm_of_missing_values_only_is_empty():
    with pytest.raises(EmptyArmError, match="condition treatment"):
        mann_whitney([float("nan")], [1.0])
