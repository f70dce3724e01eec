"""From checked data to what methods take."""

import math
from dataclasses import replace

import pytest

from analysis import outcome, read_dataset
from tests.analysis.rows import as_csv, six_participants

KEPT = (
    "participant",
    "condition",
    "scenario",
    "trial_index",
    "correct",
    "stop_time_s",
    "length_s",
    "confidence",
)


@pytest.fixture
def table(tmp_path):
    """Trials from elsewhere, the first without a guess."""
    rows = [{name: row[name] for name in KEPT} for row in six_participants()]
    rows[0]["correct"] = None
    return as_csv(tmp_path / "t.csv", rows)


@pytest.mark.parametrize(
    ("measure", "unit", "of_the_last"),
    [
        ("correct", "share", 0.0),
        ("prediction_time_s", "s", 20.0),
        ("stop_time_s", "s", 14.0),
        ("confidence", "scale points", 2.0),
    ],
)
def test_a_measure_comes_as_numbers_with_its_unit(table, measure, unit, of_the_last):
    found = outcome(read_dataset(table), measure)
    assert (found.name, found.unit) == (measure, unit)
    assert found.y.dtype == float
    assert found.y[-1] == of_the_last


def test_what_is_missing_is_nan_and_what_follows_from_it_too(table):
    data = read_dataset(table)
    missing = {
        m: outcome(data, m).n_missing for m in ("correct", "prediction_time_s", "confidence")
    }
    assert missing == {"correct": 1, "prediction_time_s": 1, "confidence": 0}
    assert math.isnan(outcome(data, "correct").y[0])


def test_the_plans_treatment_is_marked(table):
    found = outcome(read_dataset(table), "correct")
    assert found.treated.tolist() == [True] * 9 + [False] * 9


def test_clusters_are_numbered_by_name_whatever_the_order_of_rows(table):
    data = read_dataset(table)
    forth = outcome(data, "confidence")
    assert forth.participant.tolist() == [number for number in range(6) for _ in range(3)]
    assert forth.scenario.tolist() == [0, 1, 2] * 6
    back = outcome(replace(data, trials=data.trials.reverse()), "confidence")
    assert back.participant.tolist() == forth.participant.tolist()[::-1]
    assert back.scenario.tolist() == forth.scenario.tolist()[::-1]
