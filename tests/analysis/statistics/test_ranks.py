"""Comparing by ranks, against frozen numbers of R, closed forms and its own symmetries."""

import math
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis import EmptyArmError
from analysis.statistics.estimates import mean
from analysis.statistics.ranks import (
    brunner_munzel,
    hodges_lehmann,
    mann_whitney,
    mann_whitney_exact_if_few,
)
from tests.analysis.statistics.cases import holds
from tests.analysis.statistics.outcomes import of_fixture

RATINGS = st.lists(st.integers(1, 7), min_size=1, max_size=30)


@pytest.mark.parametrize("case_id", ["mw_no_ties", "mw_likert_ties"])
def test_golden_mann_whitney(golden, case_id):
    """R 4.2.2 wilcox.test, exactRankTests 0.8; Brunner-Munzel by formula in R."""
    case = golden(case_id)
    check_ranks(case, case["input"]["x"], case["input"]["y"])


def test_golden_mann_whitney_of_the_papers_confidence_counts(golden):
    """R 4.2.2 wilcox.test; Brunner-Munzel by formula in R."""
    case = golden("paper_confidence_counts")
    levels = case["input"]["levels"]
    x, y = (np.repeat(levels, case["input"][counts]) for counts in ("x_counts", "y_counts"))
    check_ranks(case, x, y)


def test_golden_mann_whitney_of_the_fixtures_times(golden, paper_fixture):
    """R 4.2.2 wilcox.test on synthetic trials; Brunner-Munzel by formula in R."""
    data = of_fixture(paper_fixture, "time")
    check_ranks(golden("paper_time_fixture"), data.y[data.treated], data.y[~data.treated])


@pytest.mark.parametrize("measure", ["correct", "confidence"])
def test_golden_mann_whitney_of_participants_means(golden, paper_fixture, measure):
    """R 4.2.2 wilcox.test on synthetic trials; Brunner-Munzel by formula in R."""
    data = of_fixture(paper_fixture, measure)
    sums = np.bincount(data.participant, data.y)
    treated = np.bincount(data.participant, data.treated) > 0
    # every participant has ten trials: whole sums keep the ties of the means exact
    x, y = sums[treated] / 10, sums[~treated] / 10
    check_ranks(golden(f"participant_mw_{measure}"), x, y)


def check_ranks(case, x, y):
    test, brunner, shift = mann_whitney(x, y), brunner_munzel(x, y), hodges_lehmann(x, y)
    found: dict[str, Any] = {
        "n1": test.n_treatment,
        "n2": test.n_reference,
        "n_missing": test.n_missing,
        "u1": test.u_treatment,
        "u2": test.u_reference,
        "u_min": test.u_smaller,
        "sd_tie_corrected": test.sd,
        "z": test.statistic,
        "p": test.p,
        "p_continuity": test.p_continuity,
        "p_exact": test.p_exact,
        "auc": test.estimate,
        "rank_biserial": test.rank_biserial,
        "median1": test.median_treatment,
        "median2": test.median_reference,
        "mean1": mean(x, "").mean,
        "mean2": mean(y, "").mean,
        "hodges_lehmann": shift.estimate,
        "brunner_munzel_t": -(brunner.statistic or 0),
        "brunner_munzel_df": brunner.df,
        "brunner_munzel_p": brunner.p,
    }
    if "hl_ci_exact" in case["expected"]:
        found["hl_ci_exact"] = [shift.low, shift.high]
    assert found.keys() | {"ties"} == case["expected"].keys()
    holds(case, found)
    for name in ("p", "p_continuity", "brunner_munzel_p"):
        assert found[name] == pytest.approx(case["expected"][name], rel=case["tol"]), name


def test_golden_all_tied_has_no_statistic_but_a_warning(golden):
    """By contract; R returns NaN."""
    case = golden("mw_all_tied")
    x, y = case["input"]["x"], case["input"]["y"]
    test, shift, brunner = mann_whitney(x, y), hodges_lehmann(x, y), brunner_munzel(x, y)
    holds(
        case,
        {
            "u1": test.u_treatment,
            "u2": test.u_reference,
            "auc": test.estimate,
            "rank_biserial": test.rank_biserial,
            "z": test.statistic,
            "p": test.p,
            "hodges_lehmann": shift.estimate,
        },
    )
    assert (brunner.statistic, brunner.p, test.p_continuity, test.p_exact) == (None, 1, 1, 1)
    for each in (test, shift, brunner):
        assert list(each.warnings) == case["expected"]["warnings"]


def test_golden_mann_whitney_of_an_empty_arm_is_a_structured_error(golden):
    case = golden("mw_empty")
    assert case["expected"] == {"error": "empty_arm"}
    for method in (mann_whitney, brunner_munzel, hodges_lehmann):
        with pytest.raises(EmptyArmError, match=r"condition reference: .* confidence, got none"):
            method(case["input"]["x"], case["input"]["y"], "confidence")


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


@given(RATINGS, RATINGS)
def test_brunner_munzel_is_scipys_with_the_sign_turned(x, y):
    found = brunner_munzel(x, y)
    assert found.estimate == pytest.approx(mann_whitney(x, y).estimate)
    if found.statistic is None:
        assert found.warnings
    else:
        t, p = stats.brunnermunzel(x, y)
        assert (found.statistic, found.p) == pytest.approx((-t, p), abs=1e-9)


def test_arms_that_do_not_overlap_leave_brunner_munzel_without_variance():
    found = brunner_munzel([5, 6, 7], [1, 2])
    assert (found.estimate, found.statistic, found.p) == (1, None, None)
    assert found.warnings == ("no_variation",)


def test_one_value_in_an_arm_is_too_few_for_an_interval():
    for method in (brunner_munzel, hodges_lehmann):
        found = method([3.0], [1.0, 2.5])
        assert (found.low, found.high, found.warnings) == (None, None, ("too_few_values",))


@given(RATINGS, RATINGS)
def test_the_exact_p_is_the_share_of_relabellings_whose_rank_sum_is_as_extreme(x, y):
    x, y = x[:4], y[:4]
    ranks = stats.rankdata(x + y)
    centre = len(x) * ranks.mean()
    extreme = [abs(sum(arm) - centre) for arm in combinations(ranks, len(x))]
    expected = np.mean(np.array(extreme) >= extreme[0] - 1e-9)
    assert mann_whitney(x, y).p_exact == pytest.approx(expected)


def test_without_ties_the_exact_p_is_scipys():
    x, y = np.random.default_rng(4).normal(size=(2, 30))
    expected = stats.mannwhitneyu(x, y, method="exact").pvalue
    assert mann_whitney(x, y).p_exact == pytest.approx(expected)


def test_few_values_without_ties_are_tested_exactly():
    """R 4.2.2: wilcox.test(x, y)$p.value; apart, 2 of the choose(6, 3) = 20 relabellings."""
    apart = mann_whitney_exact_if_few([4, 5, 6], [1, 2, 3], of="participants")
    assert apart.p == pytest.approx(0.1, abs=1e-15)
    assert (apart.symbol, apart.statistic) == ("U", 9)
    assert apart.method == "Mann-Whitney, two-sided, exact, on participants, few and without ties"
    x, y = [3.1, 4.7, 5.2, 6.9, 8.8, 9.3], [1.2, 2.5, 2.9, 4.1, 5.0]
    assert mann_whitney_exact_if_few(x, y).p == pytest.approx(0.0303030303030303)


@pytest.mark.parametrize(
    ("x", "y"), [([4, 5, 6], [1, 2, 4]), (range(50), np.arange(3) + 0.5), ([2, 2], [2])]
)
def test_with_ties_or_50_values_in_an_arm_the_test_stays_asymptotic(x, y):
    found = mann_whitney_exact_if_few(x, y)
    assert found == mann_whitney(x, y)
    assert "normal approximation" in found.method


def test_up_to_49_values_in_an_arm_the_test_is_exact():
    found = mann_whitney_exact_if_few(range(49), [n + 0.5 for n in range(49)])
    assert "exact" in found.method
    assert found.p == pytest.approx(found.p_exact)


def test_from_50_values_in_an_arm_there_is_no_exact_p():
    assert mann_whitney(range(49), range(49)).p_exact is not None
    assert mann_whitney(range(50), range(3)).p_exact is None


def test_a_million_equal_values_have_no_statistic_either():
    test = mann_whitney(np.full(600_001, 7.0), np.full(400_000, 7.0))
    assert (test.sd, test.statistic, test.p) == (0, None, 1)
