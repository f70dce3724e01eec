"""The measures over whole columns: each row goes through the definition in `measures`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import polars as pl

from . import measures


def correct_guesses(guess: pl.Series, goal: pl.Series) -> pl.Series:
    """Return whether each guess was correct; null where guess or goal is missing."""
    return _row_by_row(measures.correct, pl.Boolean(), guess, goal)


def prediction_times_s(
    stop_time_s: pl.Series, length_s: pl.Series, correct: pl.Series
) -> pl.Series:
    """Return each trial's time of prediction, s; null where a part is missing or impossible."""
    possible = _possible(stop_time_s, length_s)
    return _row_by_row(measures.prediction_time_s, pl.Float64(), possible, length_s, correct)


def scores(correct: pl.Series, stop_time_s: pl.Series, length_s: pl.Series) -> pl.Series:
    """Return each trial's points, 0 to 10; null where a part is missing or impossible."""
    possible = _possible(stop_time_s, length_s)
    return _row_by_row(measures.score, pl.Float64(), correct, possible, length_s)


def too_fast_stops(stop_time_s: pl.Series, first_decision_s: pl.Series) -> pl.Series:
    """Return whether each stop was too fast; null where a time is missing."""
    return _row_by_row(measures.too_fast, pl.Boolean(), stop_time_s, first_decision_s)


def _possible(stop_time_s: pl.Series, length_s: pl.Series) -> pl.Series:
    """Return the stop times, null where they break 0 <= stop <= length or there is no length.

    Such rows are errors, which the rules of the trials report; here they only must not count.
    """
    sound = (stop_time_s >= 0) & (stop_time_s <= length_s) & (length_s > 0)
    return stop_time_s.zip_with(sound, stop_time_s.clear(len(stop_time_s)))


def _row_by_row(
    definition: Callable[..., Any], dtype: pl.DataType, *columns: pl.Series
) -> pl.Series:
    values = [None if None in cells else definition(*cells) for cells in zip(*columns, strict=True)]
    return pl.Series(values, dtype=dtype)
