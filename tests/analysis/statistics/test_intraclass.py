"""The intraclass correlation against the library's analysis of variance and textbook limits."""

import numpy as np
import pytest
from scipy import stats

from analysis.statistics.intraclass import intraclass_correlation
from tests.analysis.statistics.cases import defined
from tests.analysis.statistics.outcomes import of_fixture, outcome


def test_f_is_that_of_statsmodels_nested_models(paper_fixture):
    from statsmodels.regression.linear_model import OLS

    trials = of_fixture(paper_fixture, "correct")
    found = intraclass_correlation(trials)
    participants = np.eye(trials.participant.max() + 1)[trials.participant]
    arms = np.column_stack([trials.treated, ~trials.treated]).astype(float)
    by_participant, by_arm = (OLS(trials.y, x).fit() for x in (participants, arms))
    f, p, df = by_participant.compare_f_test(by_arm)
    assert (found.statistic, found.p) == pytest.approx((f, p))
    assert found.df == (df, 1350)
    assert found.estimate == pytest.approx((f - 1) / (f + 9))


def test_it_finds_the_correlation_that_was_put_in_and_no_difference_between_arms():
    rng = np.random.default_rng(11)
    participant = np.repeat(np.arange(2000), rng.integers(2, 9, 2000))
    treated = participant % 2 == 0
    y = rng.normal(size=2000)[participant] + rng.normal(0, 2, len(participant)) + 9 * treated
    found = defined(intraclass_correlation(outcome(y, treated, participant, participant)))
    assert found.low < 0.2 < found.high
    assert found.high - found.low < 0.06
    sizes = np.bincount(participant)
    assert found.trials_per_participant == pytest.approx((sizes**2).sum() / len(participant))


def test_searles_interval_ends_where_f_is_at_its_quantiles(paper_fixture):
    found = defined(intraclass_correlation(of_fixture(paper_fixture, "confidence")))
    for bound, quantile in ((found.low, 0.975), (found.high, 0.025)):
        ratio = (1 + 9 * bound) / (1 - bound)
        assert found.statistic / ratio == pytest.approx(stats.f.ppf(quantile, *found.df))


@pytest.mark.parametrize(
    ("trials", "estimate", "warning"),
    [
        (outcome([1, 0, 0, 1], [1, 1, 0, 0], [*"aabb"], [*"stst"]), None, "one_participant"),
        (outcome([1, 0, 0, 1], [1, 1, 0, 0], [*"abcd"], [*"stst"]), None, "single_trials"),
        (outcome([0.1] * 8, [1] * 4 + [0] * 4, [*"aabbccdd"], [*"st"] * 4), None, "no_variation"),
        (
            # sums of seven equal numbers that rounding blurs
            outcome(
                np.repeat([0.3, 0, 0, 0.8], 7), [1] * 14 + [0] * 14, np.arange(28) // 7, [0] * 28
            ),
            1.0,
            "no_variation",
        ),
    ],
)
def test_where_participants_or_trials_do_not_vary_f_is_not_defined(trials, estimate, warning):
    found = intraclass_correlation(trials)
    assert (found.estimate, found.statistic, found.p) == (estimate, None, None)
    assert found.warnings == (warning,)
