"""The intraclass correlation against the library's analysis of variance and textbook limits."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from analysis.statistics.design_effect import design_effect
from analysis.statistics.intraclass import (
    intraclass_correlation,
    intraclass_correlation_of_ranks,
)
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
    assert (found.statistic, found.p) == pytest.approx((f, 2 * p))
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


def test_searles_interval_ends_where_f_is_at_its_quantiles(paper_fixture):
    found = defined(intraclass_correlation(of_fixture(paper_fixture, "confidence")))
    for bound, quantile in ((found.low, 0.975), (found.high, 0.025)):
        ratio = (1 + 9 * bound) / (1 - bound)
        assert found.statistic / ratio == pytest.approx(stats.f.ppf(quantile, *found.df))


def test_p_is_of_the_interval_also_where_trials_are_less_alike_than_by_chance():
    """scipy's F: each participant has one value of each kind, so F is below its 2.5 % quantile."""
    participant = np.repeat(np.arange(8), 2)
    y = np.tile([0.0, 1.0], 8) + 0.01 * participant
    found = defined(intraclass_correlation(outcome(y, participant < 4, participant, participant)))
    assert found.high < 0
    assert found.p == pytest.approx(2 * stats.f.cdf(found.statistic, 6, 8))
    assert found.p < 0.05


def two_trials_each_in_the_reference_arm(data):
    """The data without what participants of the reference arm answered after their second trial."""
    first = [np.flatnonzero(data.participant == each)[:2] for each in np.unique(data.participant)]
    kept = data.treated | np.isin(np.arange(len(data.y)), np.concatenate(first))
    columns = (data.y, data.treated, data.participant, data.scenario)
    return outcome(*(column[kept] for column in columns))


@pytest.mark.parametrize("icc", [0.0, 0.2, 1.0])
def test_with_unequal_arms_the_design_effect_is_that_of_the_matrix_of_covariances(icc):
    participant = np.repeat(np.arange(9), [1, 2, 9, 4, 4, 1, 1, 2, 3])
    treated = participant < 5
    found = intraclass_correlation(outcome(participant % 3, treated, participant, participant))
    weights = np.where(treated, 1 / treated.sum(), -1 / (~treated).sum())
    alike = np.equal.outer(participant, participant)
    covariances = icc * alike + (1 - icc) * np.eye(len(participant))
    expected = weights @ covariances @ weights / (weights @ weights)
    assert design_effect(icc, found.trials_per_participant) == pytest.approx(expected)


@pytest.mark.parametrize("trials", [1, 10])
def test_where_all_have_the_same_number_of_trials_exactly_that_number_counts(trials):
    participant = np.repeat(np.arange(150), trials)
    found = intraclass_correlation(outcome(participant, participant < 98, participant, participant))
    assert found.trials_per_participant == trials


@pytest.mark.parametrize("measure", ["time", "confidence"])
@pytest.mark.parametrize("shorten", [lambda data: data, two_trials_each_in_the_reference_arm])
def test_by_ranks_the_design_effect_is_near_what_clustering_does_to_the_variance(
    paper_fixture, measure, shorten
):
    """statsmodels' least squares of scipy's ranks, with and without clusters."""
    from statsmodels.regression.linear_model import OLS

    data = shorten(of_fixture(paper_fixture, measure))
    arms = np.column_stack([np.ones(len(data.y)), data.treated])
    model = OLS(stats.rankdata(data.y), arms)
    clusters = {"groups": data.participant, "use_correction": False}
    clustered = model.fit(cov_type="cluster", cov_kwds=clusters).bse[1]
    independent = model.fit(cov_type="HC0").bse[1]
    found = intraclass_correlation_of_ranks(data)
    effect = design_effect(found.estimate or 0, found.trials_per_participant)
    assert effect == pytest.approx((clustered / independent) ** 2, rel=0.1)


def test_of_ranks_only_the_order_of_values_matters(paper_fixture):
    data = of_fixture(paper_fixture, "time")
    data.y[3] = np.nan
    found = intraclass_correlation_of_ranks(data)
    assert found == intraclass_correlation_of_ranks(replace(data, y=np.log(data.y)))
    assert (found.n, found.n_missing) == (1499, 1)
    assert found.method.endswith("of mid-ranks")


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
