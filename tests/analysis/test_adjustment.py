"""What the plan's covariates are of each trial, and what the report tells of the models."""

import shutil
from dataclasses import replace

import pytest

from analysis import PARTICIPANTS, TRIALS, adjustment, analyse_path, methods, write_table
from analysis.adjustment import _TERMS, TIME_TO_STOP
from analysis.plan import COVARIATES
from analysis.reporting.as_json import as_json
from analysis.reporting.fine_print import fine_print_parts
from analysis.reporting.markdown import markdown
from analysis.reporting.report import report_parts
from tests.analysis.rows import participant_row, participants_of, six_participants
from tests.analysis.statistics.outcomes import column_of_fixture
from tests.analysis.statistics.test_adjusted import COX, LOGISTIC

ALL = 'covariates = ["trial_order", "age", "device"]'
NAMES = {
    "order": "trial order, per trial",
    "age": "age, per year",
    "unknown": "age not told",
    "touch": "device: touch against mouse",
}


def made_up_person(participant, condition):
    """The participant that the R code in statistics/test_adjusted.py makes, but for the pens."""
    number = int(participant[1:])
    pointer = "touch" if number % 5 == 3 else "pen" if number % 37 == 0 else "mouse"
    age = None if number % 29 == 0 else 18 + 7 * number % 50
    return participant_row(participant, condition, age=age, pointer_type=pointer)


@pytest.fixture(scope="module")
def adjusted(paper_fixture, tmp_path_factory):
    """The synthetic trials with made-up ages and devices, analysed with all covariates."""
    from analysis.plan import read_plan

    folder = tmp_path_factory.mktemp("export")
    shutil.copy(paper_fixture, folder / "trials.csv")
    names = (column_of_fixture(paper_fixture, each) for each in ("participant", "condition"))
    people = dict(zip(*names, strict=True))
    write_table(PARTICIPANTS, [made_up_person(*each) for each in people.items()], folder)
    plan = folder / "plan.toml"
    plan.write_text(ALL)
    return analyse_path(folder, read_plan(plan))


@pytest.fixture
def of_six(tmp_path, plan_of):
    """Analyse six participants, changed as told, by a plan."""

    def run(change, plan):
        rows = six_participants()
        people = participants_of(rows)
        change(people)
        write_table(TRIALS, rows, tmp_path)
        write_table(PARTICIPANTS, people, tmp_path)
        return analyse_path(tmp_path, plan_of(plan))

    return run


def test_every_covariate_that_a_plan_may_name_is_known():
    assert tuple(_TERMS) == COVARIATES


@pytest.mark.parametrize(("key", "frozen"), [("correct", LOGISTIC), (TIME_TO_STOP, COX)])
def test_the_models_of_a_study_are_those_of_r(adjusted, key, frozen):
    model = adjusted.evidence.adjustment.models[key]
    assert model.effect.estimate == pytest.approx(frozen["arm"][0], abs=2e-5)
    found = {each.term: (each.estimate, each.se) for each in model.coefficients}
    assert found.keys() == set(NAMES.values())
    for name, term in NAMES.items():
        assert found[term] == pytest.approx(frozen[name], abs=2e-5)


def test_who_did_not_tell_stays_in_and_what_is_rare_is_told(adjusted):
    assert adjusted.evidence.adjustment.notes == (
        "age: participants who did not tell theirs: 5; their trials count at the mean age, with a "
        "term of their own",
        "device: pen is too rare to be estimated (participants: 3) and counts as mouse",
    )
    assert {each.effect.n for each in adjusted.evidence.adjustment.models.values()} == {1500}


def test_the_primary_tests_are_those_of_a_plan_without_covariates(adjusted, paper):
    for measure, compared in paper.evidence.comparisons.items():
        assert adjusted.evidence.comparisons[measure].primary == compared.primary
    assert adjusted.evidence.two_way_cox == paper.evidence.two_way_cox


def test_the_report_shows_each_model_without_and_with_covariates(adjusted):
    text = markdown(report_parts(adjusted))
    table = text.partition("### Adjusted for covariates")[2].partition("###")[0]
    assert "stay unadjusted" in table
    for row in (
        "| PoLMDP against optimal, unadjusted | odds ratio 2.70 | 1.86 to 3.93 | t(36) = 5.39 |",
        "| PoLMDP against optimal, adjusted | odds ratio 2.62 | 1.81 to 3.81 | t(36) = 5.27 |",
        "| age, per year | odds ratio 1.01 | 0.99 to 1.02 | t(36) = 1.14 | .261 | 1,500 |",
        "| PoLMDP against optimal, unadjusted | hazard ratio 1.71 | 1.47 to 2.00 |",
        "| device: touch against mouse | hazard ratio 0.93 |",
        "- Device: pen is too rare to be estimated",
    ):
        assert row in table
    fine_print = markdown(fine_print_parts(adjusted.data, adjusted.evidence, {}))
    assert "- covariates: trial_order; age; device" in fine_print
    assert "Adjusted for covariates: Crossed mixed model on the logit scale" in fine_print


def test_report_json_has_effect_and_coefficients_at_full_precision(adjusted, paper):
    assert as_json(paper)["adjusted_for_covariates"] is None
    model = as_json(adjusted)["adjusted_for_covariates"]["models"]["correct"]
    assert model["effect"]["estimate"] == pytest.approx(LOGISTIC["arm"][0], abs=2e-5)
    assert [each["term"] for each in model["coefficients"]] == list(NAMES.values())
    assert {"estimate", "se", "low", "high", "p", "unit"} <= model["coefficients"][0].keys()


def test_without_covariates_nothing_is_adjusted_and_nothing_said(paper):
    assert paper.evidence.adjustment is None
    assert "Adjusted" not in markdown(report_parts(paper))


def test_what_a_table_of_trials_alone_does_not_have_is_told(paper_fixture, plan_of):
    found = analyse_path(paper_fixture, plan_of(ALL)).evidence.adjustment
    assert found is not None
    assert found.notes == (
        "age: not adjusted for, because the data do not have it",
        "device: not adjusted for, because the data do not have it",
    )
    terms = {each.term for model in found.models.values() for each in model.coefficients}
    assert terms == {"trial order, per trial"}


def test_an_age_that_nobody_told_and_a_device_that_everybody_has_adjust_for_nothing(of_six):
    def ageless(people):
        for each in people:
            each["age"] = None

    found = of_six(ageless, 'covariates = ["age", "device"]').evidence.adjustment
    assert (found.models, found.left_out) == ({}, {})
    assert found.notes == ("age: not adjusted for, because the data do not have it",)


def test_a_few_who_did_not_tell_their_age_get_no_term_of_their_own(of_six):
    def aged(people):
        for number, each in enumerate(people):
            each["age"] = None if number == 0 else 20 + number**2

    found = of_six(aged, 'covariates = ["age"]').evidence.adjustment
    assert found.notes == (
        "age: participants who did not tell theirs: 1; their trials count at the mean age, too few "
        "for a term of their own",
    )
    (coefficient,) = found.models[TIME_TO_STOP].coefficients
    assert coefficient.term == "age, per year"


def test_a_device_of_as_many_as_are_needed_has_a_term_and_an_unknown_one_is_a_device(
    of_six, monkeypatch
):
    def pointed(people):
        pointers = ("mouse", "touch", None, "mouse", "touch", "pen")
        for each, pointer in zip(people, pointers, strict=True):
            each["pointer_type"] = pointer

    monkeypatch.setattr(adjustment, "FEWEST", 2)
    found = of_six(pointed, 'covariates = ["device"]').evidence.adjustment
    terms = [each.term for each in found.models[TIME_TO_STOP].coefficients]
    assert terms == ["device: touch against mouse"]
    assert found.notes == (
        "device: not told is too rare to be estimated (participants: 1) and counts as mouse",
        "device: pen is too rare to be estimated (participants: 1) and counts as mouse",
    )


def test_an_age_that_is_the_condition_is_told_and_left_out(of_six):
    def apart(people):
        for each in people:
            each["age"] = 20 if each["condition"] == "polmdp" else 50

    found = of_six(apart, 'covariates = ["age"]').evidence.adjustment
    assert found.models == {}
    assert found.notes[0].startswith("age, per year: not adjusted for, the same in all trials, or")


def test_a_model_that_takes_too_long_is_left_out_adjusted_too(paper_fixture, plan_of, monkeypatch):
    few = {"crossed_ordinal": replace(methods._OF_CONFIDENCE["crossed_ordinal"], most_trials=1_499)}
    monkeypatch.setattr(methods, "_OF_CONFIDENCE", few)
    found = analyse_path(paper_fixture, plan_of(ALL))
    assert found.evidence.adjustment is not None
    assert set(found.evidence.adjustment.models) == {"correct", TIME_TO_STOP}
    told = markdown(report_parts(found))
    assert "- Confidence: left out, takes too long above 1,499 trials." in told
