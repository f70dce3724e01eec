"""The primary tests on some of the participants: run once, as if nobody else had taken part."""

import pytest

from analysis import TRIALS, read_dataset, write_table
from analysis import selections as module
from analysis.dataset import outcome
from analysis.methods import primary_test
from analysis.selections import Selector
from tests.analysis.rows import six_participants


@pytest.fixture
def rows():
    return six_participants()


def read(rows, folder):
    return read_dataset(write_table(TRIALS, rows, folder)[0])


def results(data):
    return {
        each.measure: primary_test(each, outcome(data, each.measure)) for each in data.plan.primary
    }


def test_a_selection_is_tested_as_if_nobody_else_had_taken_part(rows, tmp_path):
    data = read(rows, tmp_path / "all")
    alone = read([row for row in rows if row["participant"] not in ("P1", "P6")], tmp_path / "some")
    found = Selector(data, results(data)).only(["P2", "P3", "P4", "P5"])
    assert found.tests == results(alone)
    assert found.participants == {"polmdp": 2, "optimal": 2}
    assert found.trials == 12


def test_the_same_participants_are_tested_once(rows, tmp_path, monkeypatch):
    data = read(rows, tmp_path)
    analysed = results(data)
    selector = Selector(data, analysed)
    one = selector.only(["P1", "P2", "P4", "P5"])
    monkeypatch.setattr(module, "primary_test", None)
    assert selector.only(["P5", "P4", "P2", "P1", "somebody without trials"]) is one
    assert selector.only(f"P{number}" for number in range(1, 7)).tests is analysed


def test_an_arm_without_a_value_has_no_test(rows, tmp_path):
    data = read(rows, tmp_path)
    found = Selector(data, results(data)).only(["P1", "P2"])
    assert found.tests == {"correct": None, "prediction_time_s": None, "confidence": None}
    assert found.participants == {"polmdp": 2, "optimal": 0}
