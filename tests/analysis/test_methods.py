"""Which methods are run on a measure, and which are left out."""

from dataclasses import replace

import pytest

from analysis import methods, read_dataset
from analysis.methods import INDEPENDENT, compare, methods_of
from analysis.statistics.crossed_test import CrossedResult


@pytest.fixture(scope="module")
def data(paper_fixture):
    return read_dataset(paper_fixture)


def primary_of(data, measure):
    return next(each for each in data.plan.primary if each.measure == measure)


@pytest.mark.parametrize("measure", ["correct", "prediction_time_s", "confidence"])
@pytest.mark.parametrize("primary", ["two_way_difference", "two_way_auc"])
def test_the_plans_test_comes_first_and_independent_trials_last(measure, primary):
    keys = list(methods_of(measure, primary, 1))
    independent = [key in INDEPENDENT for key in keys]
    assert keys[0] == primary
    assert independent == sorted(independent)


def test_a_method_that_would_take_too_long_is_left_out_and_says_so(data, monkeypatch):
    few = {
        "crossed_ordinal": replace(methods._OF_CONFIDENCE["crossed_ordinal"], most_trials=1_499),
    }
    monkeypatch.setattr(methods, "_OF_CONFIDENCE", few)
    found = compare(data, primary_of(data, "confidence"))
    assert "crossed_ordinal" not in found.results
    assert found.left_out == {"crossed_ordinal": "takes too long above 1,499 trials"}


@pytest.mark.parametrize(
    ("measure", "model"), [("correct", "crossed_logistic"), ("confidence", "crossed_ordinal")]
)
def test_mixed_models_let_scenarios_differ_between_the_arms(data, measure, model):
    found = compare(data, primary_of(data, measure)).results[model]
    assert isinstance(found, CrossedResult)
    assert found.sd_scenario_in_arm
    assert "with scenarios within arms, maximum likelihood" in found.method


def test_methods_that_estimate_the_same_agree(data):
    found = compare(data, primary_of(data, "correct")).results
    for key in ("clustered_difference", "cluster_permutation", "risk_difference"):
        assert found[key].estimate == pytest.approx(found["two_way_difference"].estimate)
    ranked = compare(data, primary_of(data, "confidence")).results
    for key in ("clustered_auc", "mann_whitney", "brunner_munzel"):
        assert ranked[key].estimate == pytest.approx(ranked["two_way_auc"].estimate)


def test_the_same_plan_gives_the_same_numbers(data):
    one, two = (compare(data, primary_of(data, "prediction_time_s")) for _ in range(2))
    assert one == two
