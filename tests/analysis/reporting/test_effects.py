"""How estimates are written: no sign before 0, and what to mind where an interval is impossible."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.reporting.effects import EFFECTS, beyond, statement
from analysis.statistics.result import TestResult


def result(low=None, high=None, *, unit="share", null=0.0, statistic=None):
    return TestResult(
        estimate=0.1,
        low=low,
        high=high,
        null=null,
        unit=unit,
        symbol="t",
        statistic=statistic,
        df=36,
        p=0.5,
        n=1500,
        n_missing=0,
        method="a method",
        source="a source",
    )


@pytest.mark.parametrize(
    ("unit", "written"),
    [
        ("share", "0.0 percentage points"),
        ("s", "0.00 s"),
        ("scale points", "0.00 scale points"),
        ("probability", ".000"),
        ("phi", ".000"),
        ("correlation", ".000"),
    ],
)
def test_a_tiny_negative_number_has_no_sign(unit, written):
    assert EFFECTS[unit].with_unit(-1e-9) == written


@given(st.sampled_from(["share", "s", "probability"]), st.floats(0, 1))
def test_a_sign_stands_before_what_is_printed_as_0_never_and_before_the_rest_always(unit, value):
    write = EFFECTS[unit].write
    sign = "-" if re.search("[1-9]", write(value)) else ""
    assert write(-value) == f"{sign}{write(value)}"


def test_a_statistic_next_to_0_has_no_sign():
    assert statement(result(statistic=-0.001), 0.05) == "t(36) = 0.00, p = .500"


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (result(-0.042, 0.6, unit="probability", null=0.5), "outside 0 to 1, where every AUC"),
        (result(0.5, 1.01, unit="probability", null=0.5), "outside 0 to 1, where every AUC"),
        (result(-1.2, 0.1), "outside -100 to 100 percentage points, where every difference"),
        (result(-0.02, 0.4, null=1 / 6), "outside 0 to 100 %, where every share"),
    ],
)
def test_an_interval_that_reaches_where_no_estimate_can_be_is_said_to(given, said):
    assert said in beyond(given)


@pytest.mark.parametrize(
    "given",
    [
        result(-0.1, 0.3),
        result(0.0, 1.0, unit="probability", null=0.5),
        result(0.884, 1.0004, unit="probability", null=0.5),
        result(-1.0004, 0.2),
        result(0.0, 1.0, null=1 / 6),
        result(-40.0, 3.0, unit="s"),
        result(),
    ],
)
def test_of_a_possible_interval_or_none_nothing_is_said(given):
    assert beyond(given) == ""
