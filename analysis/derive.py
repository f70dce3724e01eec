"""The measures over whole columns: expressions that say what `measures` defines row by row.

Each takes the contract's columns and is null where one that it needs is missing.
"""

from __future__ import annotations

import polars as pl

from .measures import FULL_SCORE

_STOP, _LENGTH, _CORRECT = (pl.col(name) for name in ("stop_time_s", "length_s", "correct"))

_POSSIBLE = (_STOP >= 0) & (_STOP <= _LENGTH) & (_LENGTH > 0)
"""Rows that break it are errors, which the rules of the trials report; they only must not count."""

CORRECT = pl.col("guess") == pl.col("goal")
"""Whether the guess was correct."""

_RIGHT = _CORRECT & _POSSIBLE
_WRONG = ~_CORRECT & _POSSIBLE.fill_null(True)
"""What follows from a wrong guess needs no stop."""

PREDICTION_TIME_S = pl.when(_RIGHT).then(_STOP).when(_WRONG).then(_LENGTH)
"""Time of prediction, s; null where the times are impossible, too."""

SCORE = (
    pl.when(_RIGHT)
    .then(pl.min_horizontal(FULL_SCORE, FULL_SCORE * (_LENGTH - _STOP) / (2 * _LENGTH / 3)))
    .when(_WRONG)
    .then(0.0)
)
"""Points, 0 to 10; null where the times are impossible, too."""

TOO_FAST = pl.col("first_decision_s") > _STOP
"""Whether Stop came before the first decision could be seen."""
