"""The marginal logistic model against frozen numbers of R, and where it is not defined."""

import pytest

from analysis.statistics.gee import gee_logistic
from analysis.statistics.outcome import Outcome
from tests.analysis.statistics.cases import defined, holds
from tests.analysis.statistics.outcomes import of_fixture, outcome


def test_golden_gee(golden, paper_fixture):
    """R geepack::geeglm, exchangeable; synthetic trials."""
    test = defined(gee_logistic(of_fixture(paper_fixture, "correct")))
    holds(
        golden("gee_fixture"),
        {
            "b0": test.intercept,
            "b1": test.estimate,
            "se_b1": test.se,
            "wald_chi2": test.statistic**2,
            "p": test.p,
            "or": test.odds_ratio,
            "alpha": test.working_correlation,
        },
    )


def four_participants(correct: str) -> Outcome:
    """Two participants an arm, three trials each; `correct` as 1 and 0 in their order."""
    return outcome(
        [int(digit) for digit in correct], [1] * 6 + [0] * 6, [*"aaabbbcccddd"], [*"stu"] * 4
    )


def test_swapping_the_arms_flips_the_sign():
    one = defined(gee_logistic(four_participants("110111100010")))
    other = defined(gee_logistic(four_participants("100010110111")))
    assert one.estimate == pytest.approx(-other.estimate)
    assert one.odds_ratio == pytest.approx(1 / other.odds_ratio)
    assert one.estimate > 0


@pytest.mark.parametrize(
    ("measured", "warning"),
    [
        (four_participants("111111100010"), "separation"),
        (four_participants("000000000000"), "separation"),
        (four_participants("111000000111"), "not_converged"),
        (four_participants("110110100100"), "no_variation"),
        (outcome([0, 1, 0, 1], [1, 1, 0, 0], [*"aabc"], [*"stst"]), "one_participant"),
        (outcome([0, 1, 0, 1], [1, 1, 0, 0], [*"abcd"], [*"stst"]), "single_trials"),
    ],
)
def test_what_cannot_be_fitted_is_not_defined_and_says_why(measured, warning):
    test = gee_logistic(measured)
    assert test.warnings == (warning,)
    assert (test.estimate, test.se, test.statistic, test.p, test.odds_ratio) == (None,) * 5
