"""Whole columns of measures give what the definitions give row by row."""

import polars as pl
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis import derive, measures

TIMES = st.one_of(st.none(), st.floats(0, 60), st.sampled_from([0.0, 3.0, 20.0]))
LETTERS = st.one_of(st.none(), st.sampled_from("ABC"))
COLUMNS = {
    "guess": pl.String,
    "goal": pl.String,
    "correct": pl.Boolean,
    "stop_time_s": pl.Float64,
    "length_s": pl.Float64,
    "first_decision_s": pl.Float64,
}
ROWS = st.lists(
    st.tuples(LETTERS, LETTERS, st.sampled_from([None, True, False]), TIMES, TIMES, TIMES),
    min_size=1,
)


def derived(rows, expression):
    frame = pl.DataFrame(rows, schema=COLUMNS, orient="row")
    return frame.select(expression.alias("derived"))["derived"].to_list()


def by_definition(rows, definition, *names):
    """Apply a definition of `measures` to each row; None where a cell it needs is missing."""
    found = []
    for cells in rows:
        row = dict(zip(COLUMNS, cells, strict=True))
        given = {name: row[name] for name in names}
        found.append(None if None in given.values() else definition(**given))
    return found


def by_definition_in_time(rows, definition):
    """The same of what follows from correct and times: a wrong guess needs no stop."""
    found = []
    for _, _, correct, stop_time_s, length_s, _ in rows:
        too_long = None not in (stop_time_s, length_s) and stop_time_s > length_s
        impossible = too_long or length_s == 0
        unknown = None in ((correct, stop_time_s, length_s) if correct else (correct,))
        times = {"stop_time_s": stop_time_s, "length_s": length_s}
        found.append(None if impossible or unknown else definition(correct=correct, **times))
    return found


@given(ROWS)
def test_whether_guesses_are_correct(rows):
    assert derived(rows, derive.CORRECT) == by_definition(rows, measures.correct, "guess", "goal")


@given(ROWS)
@pytest.mark.parametrize(
    ("expression", "definition"),
    [
        (derive.PREDICTION_TIME_S, measures.prediction_time_s),
        (derive.SCORE, measures.score),
    ],
    ids=["time of prediction", "score"],
)
def test_what_follows_from_times_and_correct(expression, definition, rows):
    expected = by_definition_in_time(rows, definition)
    # polars multiplies by 1 / 3 where Python divides by 3
    nearly = [each if each is None else pytest.approx(each, rel=1e-14) for each in expected]
    assert derived(rows, expression) == nearly


@given(ROWS)
def test_whether_stops_are_too_fast(rows):
    needed = ("stop_time_s", "first_decision_s")
    assert derived(rows, derive.TOO_FAST) == by_definition(rows, measures.too_fast, *needed)
