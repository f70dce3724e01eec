"""The clustered Cox regression against R's numbers, statsmodels and its own symmetries."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from statsmodels.duration.hazard_regression import PHReg

from analysis.statistics.codes import NO_VARIATION, ONE_PARTICIPANT, SEPARATION
from analysis.statistics.cox import clustered_cox, two_way_cox
from analysis.statistics.survival import CENSORED, CORRECT, WRONG, Stops
from tests.analysis.statistics.cases import defined, holds
from tests.analysis.statistics.outcomes import stops_of_fixture

TRIALS = st.lists(
    st.tuples(
        st.integers(1, 6),  # time; few, so that many are tied
        st.sampled_from([CENSORED, CORRECT, WRONG]),
        st.integers(0, 7),  # participant; the even ones are treated
    ),
    max_size=40,
)


def made(trials):
    """Stops from (time, ending, participant), after one correct stop of each of four."""
    trials = [*((1 + who % 3, CORRECT, who) for who in range(4)), *trials]
    time, ending, who = (np.array(column) for column in zip(*trials, strict=True))
    return Stops(time.astype(float), ending.astype(np.int8), who % 2 == 0, who, (time + who) % 3, 0)


def estimated(given):
    """The test of stops that have an estimate and an error."""
    test = clustered_cox(given)
    assume(test.se is not None)
    return test


def of_arms(treatment, reference):
    """Correct stops at these times, every trial of another participant."""
    time = np.array([*treatment, *reference], dtype=float)
    n = len(time)
    each = np.arange(n)
    return Stops(time, np.full(n, CORRECT, np.int8), each < len(treatment), each, each % 4, 0)


def test_golden_cox_of_the_synthetic_fixture(golden, paper_fixture):
    """R survival::coxph, Efron ties, cluster = participant."""
    case = golden("cox_fixture")
    test = clustered_cox(stops_of_fixture(paper_fixture))
    names = {"loghr": test.estimate, "robust_se": test.se, "naive_se": test.naive_se}
    holds(case, names | {"p": test.p})
    assert test.p == pytest.approx(case["expected"]["p"], rel=1e-3)
    assert (test.n, test.n_events, test.n_participants) == (1500, 1194, 150)


R_TWO_WAY = """
library(survival)
d <- read.csv("paper_fixture.csv")
d$event <- d$correct == 1 & d$stop_time < d$video_length
fit <- coxph(Surv(stop_time, event) ~ I(condition == "polmdp"), d,
             eps = 1e-14, toler.chol = 1e-15)
h <- residuals(fit, type = "score") * vcov(fit)[1]
by <- function(c) { s <- tapply(h, c, sum); length(s) / (length(s) - 1) * sum(s^2) }
v <- c(by(d$participant), by(d$video), by(seq_along(h)))
c(coef(fit), v, sqrt(max(v[1] + v[2] - v[3], v[1])))
"""
"""Its numbers in R 4.2.2, survival 3.5-3: log hazard ratio, variances, standard error."""


def test_golden_two_way_cox_of_the_synthetic_fixture(paper_fixture):
    """R survival::coxph's score residuals, two-way clustered by formula, `R_TWO_WAY`."""
    test = defined(two_way_cox(stops_of_fixture(paper_fixture)))
    found = (test.estimate, test.v_participant, test.v_scenario, test.v_trial, test.se)
    expected = (
        0.539103263187,
        0.00543387045833,
        0.00419273360239,
        0.00373366751174,
        0.0767654645591,
    )
    assert found == pytest.approx(expected, abs=1e-11)
    assert (test.n_events, test.participants, test.scenarios, test.df) == (1194, 150, 37, 36)


@given(TRIALS)
def test_both_variances_are_of_one_estimate(trials):
    given = made(trials)
    one, other = clustered_cox(given), two_way_cox(given)
    assert (one.estimate, one.hazard_ratio) == (other.estimate, other.hazard_ratio)
    assert (one.n, one.n_events, one.n_participants) == (
        other.n,
        other.n_events,
        other.participants,
    )


def test_with_scenarios_of_one_trial_each_it_is_the_error_by_participant():
    """Participants' share in the two-way variance has P / (P - 1), R's cluster has not."""
    given = of_arms(treatment=[1, 2, 5, 7, 8, 11], reference=[3, 4, 6, 9, 10, 12])
    given = replace(given, participant=np.arange(12) // 2, scenario=np.arange(12))
    expected = defined(clustered_cox(given)).se * math.sqrt(6 / 5)
    assert defined(two_way_cox(given)).se == pytest.approx(expected)


def test_scenarios_that_favour_an_arm_raise_the_two_way_error_only():
    """Of 6 participants an arm every one sees 4 scenarios; two favour the treatment, two do not."""
    participant, scenario = (each.ravel() for each in np.indices((12, 4)))
    treated = participant < 6
    time = 5.0 + participant % 6 / 10 + scenario / 50 - 3 * (treated == (scenario < 2))
    given = Stops(time, np.full(48, CORRECT, np.int8), treated, participant, scenario, 0)
    one, other = defined(clustered_cox(given)), defined(two_way_cox(given))
    assert other.se > 2 * one.se


def test_one_scenario_does_not_tell_how_scenarios_differ():
    given = of_arms(treatment=[1, 4, 5], reference=[2, 3, 6])
    test = two_way_cox(replace(given, scenario=np.zeros(6, dtype=np.int64)))
    assert test.estimate is not None
    assert (test.se, test.p, test.warnings) == (None, None, ("one_scenario",))


@given(TRIALS)
def test_estimate_and_naive_error_are_those_of_statsmodels(trials):
    given = made(trials)
    test = clustered_cox(given)
    assume(test.estimate is not None)
    theirs = PHReg(
        given.time_s, given.treated[:, None].astype(float), given.ending == CORRECT, ties="efron"
    ).fit()
    assert test.estimate == pytest.approx(theirs.params[0], abs=1e-5)
    assert test.naive_se == pytest.approx(theirs.bse[0], abs=1e-5)


@given(TRIALS)
def test_swapping_the_arms_changes_the_sign_and_nothing_else(trials):
    given = made(trials)
    swapped = replace(given, treated=~given.treated)
    one, other = estimated(given), estimated(swapped)
    assert (one.estimate, one.low) == pytest.approx((-other.estimate, -other.high), abs=1e-9)
    assert (one.se, one.p) == pytest.approx((other.se, other.p))


@given(TRIALS)
def test_only_the_order_of_times_matters(trials):
    given = made(trials)
    later = replace(given, time_s=given.time_s**3)
    assert clustered_cox(given) == clustered_cox(later)


@given(TRIALS, st.randoms())
def test_the_order_of_trials_changes_nothing(trials, random):
    one = estimated(made(trials))
    random.shuffle(trials)
    other = estimated(made(trials))
    assert (one.estimate, one.se) == pytest.approx((other.estimate, other.se), abs=1e-9)


@given(TRIALS)
def test_the_ratio_is_the_exponential_and_p_and_interval_tell_the_same(trials):
    test = estimated(made(trials))
    assert math.log(test.hazard_ratio) == pytest.approx(test.estimate, abs=1e-12)
    assert math.log(test.hazard_ratio_high) == pytest.approx(test.high)
    assert test.p == pytest.approx(math.erfc(abs(test.statistic) / math.sqrt(2)))
    assert (test.low > 0 or test.high < 0) == (test.p < 0.05)


def test_whoever_is_always_first_is_sooner():
    test = clustered_cox(of_arms(treatment=[1, 2, 3, 9], reference=[4, 5, 6, 7]))
    assert test.hazard_ratio is not None
    assert test.hazard_ratio > 1


def test_the_error_of_untied_single_trials_is_the_one_lifelines_gives():
    """lifelines 0.30.3 CoxPHFitter().fit(..., robust=True) on these times, once."""
    test = clustered_cox(of_arms(treatment=[1, 2, 5, 7, 11], reference=[3, 4, 6, 8, 9, 10]))
    assert (test.estimate, test.se) == pytest.approx((0.08228091, 0.64764807), abs=1e-5)


def test_trials_of_one_participant_count_together():
    apart = of_arms(treatment=[1, 2, 5, 7, 8, 11], reference=[3, 4, 6, 9, 10, 12])
    together = replace(apart, participant=np.arange(12) // 2)
    one, other = clustered_cox(apart), clustered_cox(together)
    assert (one.estimate, one.naive_se) == (other.estimate, other.naive_se)
    assert one.se != pytest.approx(other.se)


@pytest.mark.parametrize("silent", [True, False])
def test_an_arm_that_never_stops_correctly_has_no_ratio(silent):
    given = of_arms(treatment=[1, 2], reference=[3, 4])
    ending = np.where(given.treated == silent, WRONG, CORRECT)
    test = clustered_cox(replace(given, time_s=np.ones(4), ending=ending, n_missing=2))
    assert (test.estimate, test.se, test.p, test.low) == (None, None, None, None)
    assert test.warnings == (SEPARATION,)
    assert (test.n, test.n_missing, test.n_events) == (4, 2, 2)


def test_no_correct_stop_at_all_has_no_ratio():
    given = of_arms(treatment=[1, 2], reference=[3, 4])
    nobody = replace(given, ending=np.full(4, CENSORED))
    assert clustered_cox(nobody).warnings == (SEPARATION,)
    test = two_way_cox(nobody)
    assert (test.estimate, test.hazard_ratio, test.warnings) == (None, None, (SEPARATION,))
    assert (test.participants, test.scenarios) == (4, 4)


def test_one_arm_done_before_the_other_begins_has_no_ratio():
    assert clustered_cox(of_arms(treatment=[1, 2], reference=[3, 4])).warnings == (SEPARATION,)


def test_one_participant_in_an_arm_leaves_the_error_open():
    given = of_arms(treatment=[1, 4], reference=[2, 3])
    test = clustered_cox(replace(given, participant=np.array([0, 0, 1, 2])))
    assert test.estimate is not None
    assert (test.se, test.p, test.warnings) == (None, None, (ONE_PARTICIPANT,))


def test_where_all_stop_at_once_the_rates_are_equal_and_there_is_no_error():
    test = clustered_cox(of_arms(treatment=[2, 2, 2], reference=[2, 2]))
    assert test.estimate == pytest.approx(0, abs=1e-9)
    assert (test.se, test.p, test.warnings) == (None, None, (NO_VARIATION,))
