"""The Rao-Scott chi-square against frozen numbers of R, and where it is not defined."""

import numpy as np
import pytest

from analysis import EmptyArmError
from analysis.statistics.rao_scott import rao_scott
from tests.analysis.statistics.cases import closely, holds
from tests.analysis.statistics.outcomes import of_fixture, outcome


def test_golden_rao_scott(golden, paper_fixture):
    """R survey::svychisq, ids = participant; synthetic trials."""
    test = rao_scott(of_fixture(paper_fixture, "correct"))
    holds(
        closely(golden("rao_scott_fixture")),
        {
            "F": test.statistic,
            "df1": test.df[0],
            "df2": test.df[1],
            "p_F": test.p,
            "chi2_uncorrected": test.chi2,
            "p_chisq": test.p_chi2,
        },
    )


def test_independent_trials_are_corrected_by_no_more_than_their_finite_number():
    rng = np.random.default_rng(7)
    treated = np.arange(4000) % 2 == 0
    correct = rng.random(4000) < np.where(treated, 0.8, 0.7)
    test = rao_scott(outcome(correct, treated, np.arange(4000), np.arange(4000)))
    assert test.design_effect == pytest.approx(4000 / 3999)
    assert test.chi2 is not None
    assert test.statistic == pytest.approx(test.chi2 * 3999 / 4000)


def test_copies_of_trials_under_the_same_participant_leave_the_statistic_alone(paper_fixture):
    trials = of_fixture(paper_fixture, "correct")
    threefold = outcome(
        *(np.tile(each, 3) for each in (trials.y, trials.treated)),
        *(np.tile(each, 3) for each in (trials.participant, trials.scenario)),
    )
    one, other = rao_scott(trials), rao_scott(threefold)
    assert one.chi2 is not None
    assert other.chi2 == pytest.approx(3 * one.chi2)
    assert other.statistic == pytest.approx(one.statistic)
    assert other.p == pytest.approx(one.p)


def four_participants(correct: str, participants: str = "aabbccdd"):
    """Four trials an arm, `correct` as 1 and 0 in their order."""
    y = [int(digit) for digit in correct]
    return outcome(y, [1] * 4 + [0] * 4, [*participants], [*"stststst"])


def test_phi_is_positive_when_the_treatment_is_right_more_often():
    assert rao_scott(four_participants("11101000")).estimate == pytest.approx(0.5)
    assert rao_scott(four_participants("10001110")).estimate == pytest.approx(-0.5)


@pytest.mark.parametrize(
    ("trials", "p", "warning"),
    [
        (four_participants("11111111"), 1.0, "degenerate_margin"),
        (four_participants("11111000"), None, "zero_cell"),
        (four_participants("11101000", "aaaabbcc"), None, "one_participant"),
        (four_participants("10101010"), None, "no_variation"),
    ],
)
def test_where_there_is_no_design_effect_the_test_is_not_defined(trials, p, warning):
    test = rao_scott(trials)
    assert (test.statistic, test.design_effect, test.p_chi2, test.p) == (None, None, None, p)
    assert test.warnings == (warning,)


def test_an_empty_arm_is_a_structured_error():
    with pytest.raises(EmptyArmError, match="condition treatment"):
        rao_scott(outcome([1, 0], [0, 0], [*"ab"], [*"ss"]))
