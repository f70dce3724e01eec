"""Models with covariates against frozen numbers of R, and against the models without them."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.statistics.adjusted import adjusted_cox, adjusted_crossed
from analysis.statistics.covariates import Covariates
from analysis.statistics.cox import two_way_cox
from analysis.statistics.mixed_model import crossed_logistic
from tests.analysis.statistics.cases import defined
from tests.analysis.statistics.outcomes import column_of_fixture, of_fixture, stops_of_fixture

R_DATA = """
library(survival); library(sandwich); library(glmmTMB); library(ordinal)
d <- read.csv("paper_fixture.csv")
k <- as.integer(sub("P", "", d$participant))
age <- 18 + (7 * k) %% 50; age[k %% 29 == 0] <- NA
d$c <- as.integer(d$condition == "polmdp"); d$jc <- interaction(d$video, d$c)
d$order <- d$trial - mean(d$trial)
d$unknown <- as.integer(is.na(age))
d$age <- ifelse(is.na(age), 0, age - mean(age, na.rm = TRUE))
d$touch <- as.integer(k %% 5 == 3)
d$event <- d$correct == 1 & d$stop_time < d$video_length
"""
"""The made-up ages and devices, in R 4.2.2; `made_up` makes the same."""

R_LOGISTIC = """
m <- glmmTMB(correct ~ c + order + age + unknown + touch + (1|participant) + (1|video) + (1|jc),
             d, binomial)
summary(m)$coefficients$cond; logLik(m); 2 * (logLik(m) - logLik(update(m, . ~ . - c)))
"""
LOGISTIC = {
    "arm": (0.96507407748635, 0.18324679007394),
    "order": (0.01734181363282, 0.02430249575951),
    "age": (0.00688083045115, 0.00602175163632),
    "unknown": (-0.72741217741785, 0.42574782595599),
    "touch": (-0.07642493551616, 0.21008316404038),
}

R_ORDINAL = """
o <- clmm(ordered(confidence) ~ c + order + age + unknown + touch + (1|participant) + (1|video),
          data = d, control = clmm.control(gradTol = 1e-7))
summary(o)$coefficients; logLik(o)
"""
ORDINAL = {
    "arm": (0.455214046490673, 0.2369489101219),
    "order": (-0.000161394629769, 0.0183908349767),
    "age": (-0.009115400245683, 0.0079821578334),
    "unknown": (-0.322761037777217, 0.6259379527087),
    "touch": (0.081063664620382, 0.2806950294421),
}

R_COX = """
f <- coxph(Surv(stop_time, event) ~ c + order + age + unknown + touch, d)
two_way <- vcovCL(f, ~ participant + video, type = "HC0", cadjust = TRUE)
of_participant <- vcovCL(f, ~ participant, type = "HC0", cadjust = TRUE)
cbind(coef(f), sqrt(pmax(diag(two_way), diag(of_participant))))
"""
COX = {
    "arm": (0.54977226352603, 0.08001360427112),
    "order": (0.00527279277440, 0.01074643925619),
    "age": (0.00115682991822, 0.00243118556557),
    "unknown": (0.12279457194326, 0.29892022448485),
    "touch": (-0.07733552564811, 0.09756625244428),
}


def made_up(path):
    """The covariates of the synthetic trials as `R_DATA` makes them."""
    number = np.array([int(each[1:]) for each in column_of_fixture(path, "participant")])
    order = np.array(column_of_fixture(path, "trial"), dtype=float)
    age, unknown = 18.0 + 7 * number % 50, number % 29 == 0
    columns = {
        "order": order - order.mean(),
        "age": np.where(unknown, 0, age - age[~unknown].mean()),
        "unknown": unknown,
        "touch": number % 5 == 3,
    }
    return Covariates(tuple(columns), np.stack([*columns.values()], axis=1).astype(float))


def told(model):
    """Estimate and standard error of the arm and of each term."""
    named = {"arm": model.effect} | {each.term: each for each in model.coefficients}
    return {name: (result.estimate, result.se) for name, result in named.items()}


def agrees(model, frozen, tolerance):
    found = told(model)
    assert found.keys() == frozen.keys()
    for name, expected in frozen.items():
        assert found[name] == pytest.approx(expected, abs=tolerance), name


def test_golden_logistic_with_covariates(paper_fixture):
    """R glmmTMB 1.1.5, `R_DATA` and `R_LOGISTIC`."""
    found = adjusted_crossed(of_fixture(paper_fixture, "correct"), made_up(paper_fixture))
    agrees(found, LOGISTIC, 2e-5)
    effect = defined(found.effect)
    assert effect.log_likelihood == pytest.approx(-714.404611468, abs=2e-5)
    assert effect.likelihood_ratio == pytest.approx(24.1000116328, abs=2e-5)
    assert found.aliased == ()


def test_golden_ordinal_with_covariates(paper_fixture):
    """R ordinal::clmm 2022.11-16, `R_DATA` and `R_ORDINAL`; without scenarios within arms."""
    data = of_fixture(paper_fixture, "confidence")
    found = adjusted_crossed(data, made_up(paper_fixture), interaction=False)
    agrees(found, ORDINAL, 1e-3)
    assert defined(found.effect).log_likelihood == pytest.approx(-1946.27599452, abs=1e-3)


def test_golden_cox_with_covariates(paper_fixture):
    """R survival::coxph 3.5-3, sandwich::vcovCL 3.0-2, `R_DATA` and `R_COX`."""
    found = adjusted_cox(stops_of_fixture(paper_fixture), made_up(paper_fixture))
    agrees(found, COX, 1e-8)


def test_coefficients_are_tested_on_the_degrees_of_freedom_of_the_arm(paper_fixture):
    data = of_fixture(paper_fixture, "correct")
    found = adjusted_crossed(data, made_up(paper_fixture))
    plain = crossed_logistic(data)
    for each in map(defined, (found.effect, *found.coefficients)):
        assert each.df == plain.df
        assert (each.low > 0 or each.high < 0) == (each.p < 0.05)
    assert {each.n for each in found.coefficients} == {plain.n}


def test_trials_without_the_measure_take_their_covariates_with_them(paper_fixture):
    data, covariates = of_fixture(paper_fixture, "correct"), made_up(paper_fixture)
    there = np.arange(len(data.y)) % 7 != 0
    lacking = replace(data, y=np.where(there, data.y, np.nan))
    shorter = replace(
        data,
        y=data.y[there],
        treated=data.treated[there],
        participant=data.participant[there],
        scenario=data.scenario[there],
    )
    one = adjusted_crossed(lacking, covariates)
    other = adjusted_crossed(shorter, covariates.of(there))
    assert told(one) == told(other)
    assert one.effect.n_missing == (~there).sum()


def test_the_unit_of_a_covariate_changes_its_coefficient_and_nothing_else(paper_fixture):
    data, years = of_fixture(paper_fixture, "correct"), made_up(paper_fixture)
    months = Covariates(years.terms, years.values * [1, 12, 1, 1])
    one, other = (told(adjusted_crossed(data, each)) for each in (years, months))
    assert other["arm"] == pytest.approx(one["arm"], abs=1e-7)
    assert np.array(other["age"]) * 12 == pytest.approx(one["age"], abs=1e-7)


def test_terms_that_follow_from_the_arm_or_from_others_are_left_out_and_named(paper_fixture):
    stops, covariates = stops_of_fixture(paper_fixture), made_up(paper_fixture)
    order, age, *_ = covariates.values.T
    terms = {
        "order": order,
        "constant": np.full(len(age), 3.0),
        "age": age,
        "arm again": 2.0 - stops.treated,
        "both": 3 * age - order + 1,
    }
    found = adjusted_cox(stops, Covariates(tuple(terms), np.stack([*terms.values()], axis=1)))
    assert found.aliased == ("constant", "arm again", "both")
    assert [each.term for each in found.coefficients] == ["order", "age"]
    alone = adjusted_cox(stops, Covariates(("order", "age"), covariates.values[:, :2]))
    assert told(found) == told(alone)


def test_without_a_term_it_is_the_model_without_covariates(paper_fixture):
    stops, data = stops_of_fixture(paper_fixture), of_fixture(paper_fixture, "correct")
    nothing = Covariates((), np.empty((len(data.y), 0)))
    plain, found = two_way_cox(stops), adjusted_cox(stops, nothing).effect
    assert (found.estimate, found.se) == (plain.estimate, plain.se)
    model, found = crossed_logistic(data), adjusted_crossed(data, nothing).effect
    assert (found.estimate, found.se) == (model.estimate, model.se)


def test_a_covariate_that_tells_every_answer_leaves_no_estimate(paper_fixture):
    data = of_fixture(paper_fixture, "correct")
    found = adjusted_crossed(data, Covariates(("the answer",), data.y[:, None]))
    assert (found.effect.estimate, found.coefficients) == (None, ())
    assert "not_converged" in found.effect.warnings


def test_a_covariate_that_tells_every_stop_leaves_no_ratio(paper_fixture):
    stops = stops_of_fixture(paper_fixture)
    found = adjusted_cox(stops, Covariates(("ending",), (stops.ending == 1.0)[:, None] * 1.0))
    assert (found.effect.estimate, found.effect.p, found.coefficients) == (None, None, ())
    assert found.effect.warnings == ("not_converged",)
