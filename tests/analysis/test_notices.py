"""What is told of the numbers: here, that the arms lost different shares of their participants."""

import json
from dataclasses import replace

import pytest

from analysis import TRIALS, analyse_path, default_plan, write_table
from analysis.exclusions import Exclusion
from analysis.reporting.as_json import as_json
from analysis.reporting.markdown import markdown
from analysis.reporting.report import report_parts
from tests.analysis.rows import trial_row

CODE = "differential_dropout"
PLAN = replace(default_plan(), trials_per_participant=2)
WITHOUT_INCOMPLETE = replace(PLAN, exclusions=(Exclusion("incomplete", {"fewer_than": 2}),))


@pytest.fixture
def results_of(tmp_path):
    """Analyse ten participants an arm, of whom so many left the reference arm after a trial."""

    def analysed(left, plan=PLAN):
        rows = [
            trial_row(f"{condition}{number}", index, condition, stop_time_s=2.0 + number + index)
            for condition in ("polmdp", "optimal")
            for number in range(10)
            for index in (1, 2)
            if not (condition == "optimal" and number < left and index == 2)
        ]
        return analyse_path(write_table(TRIALS, rows, tmp_path)[0], plan)

    return analysed


def codes(results):
    return [notice.code for notice in results.notices]


@pytest.mark.parametrize("plan", [PLAN, WITHOUT_INCOMPLETE])
def test_dropout_that_differs_is_noted_whether_those_who_left_are_excluded_or_not(results_of, plan):
    """All 6 who left of one arm of 10 and 10: p = 2 C(10, 6) / C(20, 6) = 420 / 38,760."""
    results = results_of(6, plan)
    (told,) = [notice.text for notice in results.notices if notice.code == CODE]
    assert told.startswith(
        "Differential dropout: 0 of 10 left with PoLMDP, 6 of 10 with optimal (Fisher's exact "
        "p = .011)."
    )
    assert told in markdown(report_parts(results)).partition("## Please note")[2]
    warnings = json.loads(json.dumps(as_json(results)))["warnings"]
    assert CODE in [warning["code"] for warning in warnings]


def test_dropout_is_noted_below_the_plans_alpha_only(results_of):
    """All 4 who left of one arm: p = 2 C(10, 4) / C(20, 4) = .087; all of 5: .033."""
    assert CODE not in codes(results_of(4))
    assert CODE in codes(results_of(5))
    assert CODE not in codes(results_of(5, replace(PLAN, alpha=0.01)))
    assert CODE in codes(results_of(4, replace(PLAN, alpha=0.1)))


def test_who_is_excluded_is_said_to_be_in_the_whole_lists(results_of):
    text = markdown(report_parts(results_of(6, WITHOUT_INCOMPLETE)))
    assert "all who began, excluded or not, count with the plan's 2 trials" in text
    assert "| correct guesses, intention to treat |" in text
    assert "all who began count" in markdown(report_parts(results_of(6)))


def test_who_has_fewer_trials_than_planned_is_counted_in_one_note(results_of):
    results = results_of(1)
    assert "fewer_trials_than_planned" in codes(results)
    assert "incomplete_participants" not in codes(results)
    nobody_has_them = replace(PLAN, trials_per_participant=3)
    assert "incomplete_participants" in codes(results_of(1, nobody_has_them))
