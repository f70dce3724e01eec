"""Crossed mixed models against frozen numbers of R, statsmodels, and their own symmetries."""

import dataclasses
import math

import numpy as np
import pytest
from scipy import integrate, stats
from scipy.special import expit, logit

from analysis import EmptyArmError
from analysis.statistics.clustered import clustered_difference
from analysis.statistics.crossed_fit import CrossedModel
from analysis.statistics.mixed_model import crossed_logistic, participant_logistic
from analysis.statistics.ordinal_mixed import crossed_ordinal
from analysis.statistics.outcome import Outcome
from tests.analysis.statistics.cases import defined, holds
from tests.analysis.statistics.outcomes import of_fixture


def made(seed, *, participants=24, scenarios=12, trials=6, sds=(0.8, 0.6, 0.4), effect=0.9):
    """Trials of both arms, as the model has it: a logistic latent value cut at 0."""
    rng = np.random.default_rng(seed)
    participant = np.repeat(np.arange(participants), trials)
    treated = participant % 2 == 0
    scenario = np.concatenate(
        [rng.choice(scenarios, trials, replace=False) for _ in range(participants)]
    )
    u, v, w = (sd * rng.normal(size=2 * participants) for sd in sds)
    eta = 0.8 + effect * treated + u[participant] + v[scenario] + w[2 * scenario + treated]
    latent = eta + rng.logistic(size=len(eta))
    return Outcome("correct", "share", (latent > 0).astype(float), treated, participant, scenario)


def rated(seed):
    """Ratings from 1 to 5 of trials with crossed effects."""
    data = made(seed)
    rng = np.random.default_rng(seed)
    ability = rng.normal(size=24)[data.participant] + 0.7 * data.treated
    y = 1.0 + np.digitize(ability + rng.logistic(size=len(ability)), [-1.5, -0.5, 0.5, 1.5])
    return dataclasses.replace(data, name="confidence", unit="1 to 7", y=y)


@pytest.mark.parametrize(
    ("case_id", "interaction"), [("glmm_crossed_fixture", False), ("glmm_crossed_x_fixture", True)]
)
def test_golden_logistic(golden, paper_fixture, case_id, interaction):
    """R glmmTMB 1.1 (Laplace) on synthetic trials."""
    case = golden(case_id)
    found = crossed_logistic(of_fixture(paper_fixture, "correct"), interaction)
    holds(
        case,
        {
            "b0": found.intercept,
            "b1": found.estimate,
            "se_b1": found.se,
            "loglik": found.log_likelihood,
            "lrt": found.likelihood_ratio,
        },
    )
    assert found.likelihood_ratio_p == pytest.approx(case["expected"]["p_lrt"], rel=1e-5)
    sds = {
        "p.(Intercept)": found.sd_participant,
        "j.(Intercept)": found.sd_scenario,
        "jc.(Intercept)": found.sd_scenario_in_arm,
    }
    expected = case["expected"]["sd"]
    assert {name: sds[name] for name in expected} == pytest.approx(expected, abs=case["tol"])
    assert (sds["jc.(Intercept)"] is None) is not interaction


def test_golden_ordinal(golden, paper_fixture):
    """R ordinal::clmm on synthetic trials."""
    case = golden("clmm_fixture")
    found = crossed_ordinal(of_fixture(paper_fixture, "confidence"), interaction=False)
    holds(
        case,
        {
            "b1": found.estimate,
            "se": found.se,
            "loglik": found.log_likelihood,
            "sd_p": found.sd_participant,
            "sd_j": found.sd_scenario,
        },
    )


def test_t_has_a_degree_of_freedom_less_than_there_are_scenarios(paper_fixture):
    found = defined(crossed_logistic(of_fixture(paper_fixture, "correct")))
    assert found.df == 36
    assert found.p == pytest.approx(2 * stats.t.sf(found.estimate / found.se, 36))
    half = stats.t.ppf(0.975, 36) * found.se
    assert (found.low, found.high) == pytest.approx((found.estimate - half, found.estimate + half))
    odds_ratio = (found.odds_ratio_low, found.odds_ratio, found.odds_ratio_high)
    assert np.log(odds_ratio) == pytest.approx([found.low, found.estimate, found.high])


def test_without_random_effects_it_is_logistic_regression():
    from statsmodels.api import Logit, add_constant

    data = made(1)
    other = Logit(data.y, add_constant(data.treated - 0.5)).fit(disp=0)
    found = CrossedModel(data.y.astype(np.int64), data.treated, [None, None, None]).fit()
    assert found is not None
    assert (found.location, found.effect) == pytest.approx(tuple(other.params), abs=1e-7)
    assert found.covariance[:2, :2] == pytest.approx(other.cov_params(), abs=1e-7)
    assert found.log_likelihood == pytest.approx(other.llf)


def test_without_random_effects_it_is_ordinal_regression():
    from statsmodels.miscmodels.ordinal_model import OrderedModel

    data = rated(1)
    model = OrderedModel(data.y, data.treated[:, None] - 0.5, distr="logit")
    other = model.fit(method="bfgs", disp=0, gtol=1e-8)
    found = CrossedModel(data.y.astype(np.int64) - 1, data.treated, [None, None, None]).fit()
    assert found is not None
    assert found.effect == pytest.approx(other.params[0], abs=1e-5)
    assert found.location == pytest.approx(-other.params[1], abs=1e-5)
    assert found.covariance[1, 1] ** 0.5 == pytest.approx(other.bse[0], abs=1e-5)
    assert found.log_likelihood == pytest.approx(other.llf)


def test_variances_estimated_as_0_leave_the_standard_error_of_logistic_regression():
    """Every participant and scenario is right equally often: less than chance would differ."""
    from statsmodels.api import Logit, add_constant

    participant, scenario = (each.ravel() for each in np.indices((24, 12)))
    treated = participant % 2 == 0
    turn = (participant // 2 + scenario) % 12
    y = (turn < np.where(treated, 9, 7)).astype(float)
    found = defined(
        crossed_logistic(Outcome("correct", "share", y, treated, participant, scenario))
    )
    other = Logit(y, add_constant(treated.astype(float))).fit(disp=0)
    assert (found.sd_participant, found.sd_scenario, found.sd_scenario_in_arm) == (0, 0, 0)
    assert found.estimate == pytest.approx(other.params[1], abs=1e-6)
    assert found.se == pytest.approx(other.bse[1], abs=1e-6)
    assert found.warnings == ("zero_variance",)
    low, high = 7 / 12, 9 / 12
    assert found.risk_difference == pytest.approx(high - low, abs=1e-6)
    # where the log odds ratio is at a bound, each arm's logit moves as it has part in the variance
    parts = np.array([1 / (high * (1 - high)), -1 / (low * (1 - low))])
    parts /= np.abs(parts).sum()
    for bound, expected in (
        (found.low, found.risk_difference_low),
        (found.high, found.risk_difference_high),
    ):
        arms = expit(logit([high, low]) + parts * (bound - found.estimate))
        assert expected == pytest.approx(arms[0] - arms[1], abs=1e-6)


def test_the_interval_of_the_risk_difference_is_that_of_the_odds_ratio_carried_over(paper_fixture):
    """R glmmTMB 1.1.5 on synthetic trials.

    d$x <- ifelse(d$condition == "polmdp", .5, -.5); d$jc <- interaction(d$video, d$condition)
    m <- glmmTMB(correct ~ x + (1 | participant) + (1 | video) + (1 | jc), d, binomial)
    fixef(m)$cond; exp(m$fit$par[3:5]); vcov(m, full = TRUE)[, 2]
    """
    location, effect = 1.45893157, 0.993889823
    sds = np.array([0.587528544, 0.495178019, 0.241752479])
    with_effect = np.array(
        [-0.00116530506, 0.0340597202, 0.00372284529, 0.000687979645, 0.0169569077]
    )  # the last three with logs of sds
    found = defined(crossed_logistic(of_fixture(paper_fixture, "correct")))
    for bound, expected in (
        (found.low, found.risk_difference_low),
        (found.estimate, found.risk_difference),
        (found.high, found.risk_difference_high),
    ):
        moved = (bound - effect) * with_effect / with_effect[1]
        sd = np.linalg.norm(sds * (1 + moved[2:]))
        treatment, reference = (
            integrate.quad(
                lambda z, eta=location + moved[0] + half, sd=sd: (
                    expit(eta + sd * z) * stats.norm.pdf(z)
                ),
                -9,
                9,
            )[0]
            for half in (bound / 2, -bound / 2)
        )
        assert expected == pytest.approx(treatment - reference, abs=1e-6)


@pytest.mark.parametrize("seed", [113, 189, 239, 314])
def test_the_risk_difference_excludes_0_only_if_the_odds_ratio_excludes_1(seed):
    """By the delta method its interval excluded 0 here, beside p from .051 to .056."""
    found = defined(crossed_logistic(made(seed, effect=1.0)))
    assert found.p > 0.05
    assert found.low < 0 < found.high
    assert found.risk_difference_low < 0 < found.risk_difference < found.risk_difference_high


def test_golden_logistic_of_participants_only(paper_fixture):
    """R glmmTMB 1.1.5 on synthetic trials.

    d$x <- as.numeric(d$condition == "polmdp")
    m <- glmmTMB(correct ~ x + (1 | participant), d, binomial); m0 the same without x
    fixef(m); sqrt(diag(vcov(m)$cond)); VarCorr(m); logLik(m); 2 * (logLik(m) - logLik(m0))
    """
    data = of_fixture(paper_fixture, "correct")
    found = defined(participant_logistic(data))
    assert (found.intercept, found.estimate) == pytest.approx(
        (0.884568483642, 0.941580239799), abs=2e-6
    )
    assert found.se == pytest.approx(0.164301936398, abs=2e-6)
    assert found.sd_participant == pytest.approx(0.537805876314, abs=2e-6)
    assert found.log_likelihood == pytest.approx(-729.644322263, abs=1e-6)
    assert found.likelihood_ratio == pytest.approx(30.4922351841, abs=1e-6)
    assert (found.sd_scenario, found.sd_scenario_in_arm, found.warnings) == (None, None, ())
    assert found.df == clustered_difference(data).df


def test_the_model_of_participants_does_not_ask_for_scenarios():
    data = made(12)
    one = dataclasses.replace(data, scenario=np.zeros_like(data.scenario))
    assert participant_logistic(one) == participant_logistic(data)
    few = participant_logistic(made(12, scenarios=8, trials=6))
    assert "few_clusters" not in few.warnings
    many = dataclasses.replace(data, scenario=np.arange(len(data.y)) * 7)
    assert participant_logistic(many) == participant_logistic(data)


def test_of_participants_with_a_trial_each_the_model_says_that_nothing_is_random():
    data = made(13)
    found = participant_logistic(dataclasses.replace(data, participant=np.arange(len(data.y))))
    assert (found.sd_participant, found.warnings) == (None, ("single_trials",))


def test_the_risk_difference_averages_over_participants_and_scenarios():
    found = defined(crossed_logistic(made(2)))
    sd = math.hypot(found.sd_participant, found.sd_scenario, found.sd_scenario_in_arm)

    def share(eta):
        return integrate.quad(lambda z: expit(eta + sd * z) * stats.norm.pdf(z), -9, 9)[0]

    expected = share(found.intercept + found.estimate) - share(found.intercept)
    assert found.risk_difference == pytest.approx(expected, abs=1e-5)
    assert found.risk_difference_low < expected < found.risk_difference_high


def test_the_likelihood_ratio_leaves_out_nothing_but_the_arm():
    """Where there is no effect it is near the square of t, and far below the effect's."""
    null = defined(crossed_logistic(made(3, effect=0.0)))
    assert 0 <= null.likelihood_ratio < 4
    assert null.likelihood_ratio == pytest.approx(null.statistic**2, abs=0.2)
    assert defined(crossed_logistic(made(3, effect=3.0))).likelihood_ratio > 10


@pytest.mark.parametrize("test", [crossed_logistic, crossed_ordinal])
def test_swapping_the_arms_flips_the_sign_and_keeps_p(test):
    data = made(4) if test is crossed_logistic else rated(4)
    one, other = (
        defined(test(data)),
        defined(test(dataclasses.replace(data, treated=~data.treated))),
    )
    assert other.estimate == pytest.approx(-one.estimate, abs=1e-6)
    assert (other.low, other.high) == pytest.approx((-one.high, -one.low), abs=1e-6)
    assert (other.se, other.p) == pytest.approx((one.se, one.p), abs=1e-6)
    assert other.likelihood_ratio == pytest.approx(one.likelihood_ratio, abs=1e-6)


@pytest.mark.parametrize("test", [crossed_logistic, crossed_ordinal])
def test_the_order_of_rows_changes_nothing(test):
    data = made(5) if test is crossed_logistic else rated(5)
    order = np.random.default_rng(5).permutation(len(data.y))
    columns = ("y", "treated", "participant", "scenario")
    shuffled = dataclasses.replace(data, **{name: getattr(data, name)[order] for name in columns})
    one, other = defined(test(data)), defined(test(shuffled))
    assert (other.estimate, other.se) == pytest.approx((one.estimate, one.se), abs=1e-6)
    assert other.log_likelihood == pytest.approx(one.log_likelihood, abs=1e-7)


def test_counting_wrong_guesses_flips_the_sign():
    data = made(6)
    one, other = (
        defined(crossed_logistic(data)),
        defined(crossed_logistic(dataclasses.replace(data, y=1 - data.y))),
    )
    assert other.estimate == pytest.approx(-one.estimate, abs=1e-6)
    assert other.risk_difference == pytest.approx(-one.risk_difference, abs=1e-6)
    assert other.se == pytest.approx(one.se, abs=1e-6)


@pytest.mark.parametrize("interaction", [False, True])
def test_two_ratings_make_the_logistic_model(interaction):
    data = made(7)
    one, other = (test(data, interaction) for test in (crossed_logistic, crossed_ordinal))
    assert (other.estimate, other.se, other.p) == (one.estimate, one.se, one.p)


def test_the_golden_logistic_is_that_of_two_ratings_with_scenarios_that_differ_between_arms(
    golden, paper_fixture
):
    """R glmmTMB 1.1 (Laplace) on synthetic trials."""
    found = crossed_ordinal(of_fixture(paper_fixture, "correct"))
    holds(
        golden("glmm_crossed_x_fixture"),
        {"b1": found.estimate, "se_b1": found.se, "loglik": found.log_likelihood},
    )


def test_scenarios_that_differ_between_the_arms_are_counted_into_the_error_of_ratings():
    """statsmodels' OrderedModel of each scenario, and the standard error of their mean effect.

    It is .53; without a term for scenarios within arms the model's is .14.
    """
    from statsmodels.miscmodels.ordinal_model import OrderedModel

    rng = np.random.default_rng(0)
    participant, scenario = (each.ravel() for each in np.indices((60, 12)))
    treated = participant % 2 == 0
    differing = rng.normal(0, 1.5, (2, 12))[treated.astype(np.int64), scenario]
    y = np.digitize(differing + rng.logistic(size=len(scenario)), [-1, 1])
    effects = [
        OrderedModel(y[own], treated[own][:, None].astype(float), distr="logit")
        .fit(method="bfgs", disp=0)
        .params[0]
        for own in (scenario == each for each in range(12))
    ]
    found = crossed_ordinal(
        Outcome("confidence", "points", y * 1.0, treated, participant, scenario)
    )
    assert defined(found).se == pytest.approx(np.std(effects) / 12**0.5, rel=0.1)


def test_only_the_order_of_ratings_matters():
    data = rated(8)
    assert crossed_ordinal(dataclasses.replace(data, y=np.exp(data.y))) == crossed_ordinal(data)


def test_missing_values_are_left_out_and_counted():
    data = made(9)
    there = np.arange(len(data.y)) % 7 > 0
    found = crossed_logistic(dataclasses.replace(data, y=np.where(there, data.y, np.nan)))
    kept = [each[there] for each in (data.y, data.treated, data.participant, data.scenario)]
    alone = crossed_logistic(Outcome("correct", "share", *kept))
    assert (found.n, found.n_missing) == (there.sum(), (~there).sum())
    assert dataclasses.replace(found, n_missing=0) == alone


def test_an_empty_arm_is_a_structured_error():
    data = made(10)
    with pytest.raises(EmptyArmError) as caught:
        crossed_logistic(dataclasses.replace(data, y=np.where(data.treated, np.nan, data.y)))
    assert (caught.value.arm, caught.value.measure) == ("treatment", "correct")


@pytest.mark.parametrize("test", [crossed_logistic, crossed_ordinal])
@pytest.mark.parametrize(
    ("change", "warning"),
    [
        (lambda data: {"y": np.ones_like(data.y)}, "constant_outcome"),
        (lambda data: {"y": np.where(data.treated, data.y.max(), data.y)}, "separation"),
        (lambda data: {"y": (data.participant % 5 < 3).astype(float)}, "not_converged"),
    ],
)
def test_without_a_maximum_there_is_no_estimate_but_a_warning(test, change, warning):
    data = made(11)
    found = test(dataclasses.replace(data, **change(data)))
    assert (found.estimate, found.se, found.p, found.log_likelihood) == (None,) * 4
    assert warning in found.warnings


@pytest.mark.parametrize(
    ("change", "warning"),
    [
        (lambda data: {"scenario": np.zeros_like(data.scenario)}, "one_scenario"),
        (lambda data: {"participant": data.treated.astype(np.int64)}, "one_participant"),
    ],
)
def test_one_cluster_gives_an_estimate_without_a_test(change, warning):
    data = made(12)
    found = crossed_logistic(dataclasses.replace(data, **change(data)))
    assert found.estimate is not None
    assert (found.se, found.p, found.low, found.risk_difference_low) == (None,) * 4
    assert warning in found.warnings


def test_a_factor_that_trials_cannot_tell_is_left_out():
    data = made(13)
    trial = np.arange(len(data.y))
    single = crossed_logistic(dataclasses.replace(data, participant=trial))
    apart = crossed_logistic(dataclasses.replace(data, scenario=2 * data.scenario + data.treated))
    assert single.sd_participant is None
    assert "single_trials" in single.warnings
    assert apart.sd_scenario_in_arm is None
    assert "no_scenario_shared" in apart.warnings


def test_without_any_factor_the_risk_difference_is_that_of_the_shares():
    data = made(13)
    nothing = np.zeros_like(data.scenario)
    alone = dataclasses.replace(data, participant=np.arange(len(data.y)), scenario=nothing)
    found = crossed_logistic(alone)
    shares = [data.y[arm].mean() for arm in (data.treated, ~data.treated)]
    assert found.risk_difference == pytest.approx(shares[0] - shares[1], abs=1e-7)
    assert found.warnings == ("single_trials", "one_scenario")


def test_few_clusters_are_told():
    assert "few_clusters" in crossed_logistic(made(14, participants=12)).warnings
    assert "few_clusters" not in crossed_logistic(made(14)).warnings


def test_more_scenarios_than_the_model_can_take_are_told():
    trial = np.arange(2008)
    treated = trial % 2 == 0
    y = (trial % 3 == 0).astype(float)
    data = Outcome("correct", "share", y, treated, trial // 2 // 4 * 2 + treated, trial // 4)
    found = crossed_logistic(data)
    assert (found.estimate, found.warnings) == (None, ("too_many_clusters",))
