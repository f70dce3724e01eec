"""Each arm's share of correct guesses against chance."""

import numpy as np
import pytest

from analysis import EmptyArmError
from analysis.statistics.chance import against_chance
from tests.analysis.statistics.cases import defined
from tests.analysis.statistics.outcomes import of_fixture, outcome

NAN = float("nan")


def test_each_arm_has_its_own_share_clusters_and_missing_trials():
    trials = outcome(
        [1, 0, 1, 1, 1, 0, 0, NAN],
        [1, 1, 1, 1, 0, 0, 0, 0],
        [*"aabbccdd"],
        [*"stststst"],
    )
    treatment, reference = against_chance(trials, 1 / 6)
    assert (treatment.estimate, treatment.n, treatment.n_missing) == (0.75, 4, 0)
    assert reference.estimate == pytest.approx(1 / 3)
    assert (reference.n, reference.n_missing) == (3, 1)
    assert (treatment.participants, treatment.scenarios, treatment.df) == (2, 2, 1)


def test_the_variance_is_that_of_statsmodels_regression_on_a_constant(paper_fixture):
    from statsmodels.regression.linear_model import OLS
    from statsmodels.stats.sandwich_covariance import cov_cluster

    trials = of_fixture(paper_fixture, "correct")
    reference = defined(against_chance(trials, 1 / 6)[1])
    arm = ~trials.treated
    fit = OLS(trials.y[arm], np.ones(arm.sum())).fit()
    for found, clusters in (
        (reference.v_participant, trials.participant[arm]),
        (reference.v_scenario, trials.scenario[arm]),
    ):
        assert found == pytest.approx(cov_cluster(fit, clusters).item())
    assert reference.statistic == pytest.approx((reference.estimate - 1 / 6) / reference.se)


def test_an_arm_that_is_always_right_is_not_tested_but_says_so():
    trials = outcome([1, 1, 1, 1, 1, 0], [1, 1, 1, 1, 0, 0], [*"aabbcd"], [*"ststst"])
    treatment, reference = against_chance(trials, 1 / 6)
    assert (treatment.estimate, treatment.p) == (1.0, None)
    assert treatment.warnings == ("few_clusters", "no_variation")
    assert reference.p is not None


def test_an_arm_without_a_guess_is_a_structured_error():
    with pytest.raises(EmptyArmError, match="condition reference"):
        against_chance(outcome([1, NAN], [1, 0], [*"ab"], [*"ss"]), 1 / 6)
