"""Rules between the cells of the trials table, and between trials and participants."""

from __future__ import annotations

from collections.abc import Callable

import polars as pl

from . import derive
from .validation import Problem, broken

TIME_TOLERANCE_S = 0.001
"""Recorded and derived times may differ by what the page's clock resolves."""

SCORE_TOLERANCE = 0.01
"""Recorded and derived scores may differ by what that does to a score."""


def trial_problems(trials: pl.DataFrame) -> list[Problem]:
    """Return what contradicts itself among the trials; `trials` is typed and has `ROW`.

    A rule is skipped where a column it needs is not in the frame, and for rows where a cell it
    needs is missing.
    """
    has = set(trials.columns)
    return [problem for needs, rule in _RULES if needs <= has for problem in rule(trials)]


def membership_problems(
    trials: pl.DataFrame, participants: pl.DataFrame, file: str
) -> list[Problem]:
    """Return the trials of nobody in the participants table, or of another kind there.

    `file` names the participants table. Condition, simulated and preview must agree: a pilot's
    trial marked as real would slip into the analysis.
    """
    same = [name for name in ("condition", "simulated", "preview") if name in trials.columns]
    known = participants.select("participant", pl.col(same).name.suffix(" there"), known=True)
    joined = trials.join(known, on="participant", how="left", maintain_order="left")
    found = broken(
        joined,
        pl.col("known").is_null(),
        "unknown_participant",
        "participant",
        f"a participant listed in {file}",
    )
    for name in same:
        found += broken(
            joined,
            pl.col("known") & pl.col(name).ne_missing(pl.col(f"{name} there")),
            f"other_{name}",
            name,
            f"the same as in {file}",
            name,
            f"{name} there",
        )
    return found


def _two_conditions(trials: pl.DataFrame) -> list[Problem]:
    first = pl.col("condition").drop_nulls().first().over("participant")
    return broken(
        trials.with_columns(earlier=first),
        pl.col("condition") != pl.col("earlier"),
        "two_conditions",
        "condition",
        "one condition per participant",
        "participant",
        "condition",
        "earlier",
    )


def _stop_after_end(trials: pl.DataFrame) -> list[Problem]:
    return broken(
        trials,
        pl.col("stop_time_s") > pl.col("length_s"),
        "stop_after_end",
        "stop_time_s",
        "a stop no later than length_s",
        "stop_time_s",
        "length_s",
    )


def _end_before_length(trials: pl.DataFrame) -> list[Problem]:
    return broken(
        trials,
        pl.col("reached_end") & (pl.col("length_s") - pl.col("stop_time_s") > TIME_TOLERANCE_S),
        "end_before_length",
        "reached_end",
        "stop_time_s equal to length_s where the end was reached",
        "stop_time_s",
        "length_s",
    )


def _decision_after_end(trials: pl.DataFrame) -> list[Problem]:
    return broken(
        trials,
        pl.col("first_decision_s") > pl.col("length_s"),
        "decision_after_end",
        "first_decision_s",
        "a decision no later than length_s",
        "first_decision_s",
        "length_s",
    )


def _contradicted_guess(trials: pl.DataFrame) -> list[Problem]:
    return broken(
        trials,
        pl.col("correct") != derive.CORRECT,
        "correct_contradicts_guess",
        "correct",
        "true if and only if guess and goal are the same",
        "correct",
        "guess",
        "goal",
    )


def _contradicted_measures(trials: pl.DataFrame) -> list[Problem]:
    found: list[Problem] = []
    for name, derived, tolerance in (
        ("prediction_time_s", derive.PREDICTION_TIME_S, TIME_TOLERANCE_S),
        ("score", derive.SCORE, SCORE_TOLERANCE),
    ):
        if name in trials.columns:
            found += broken(
                trials.with_columns(derived=derived),
                (pl.col(name) - pl.col("derived")).abs() > tolerance,
                f"{name}_contradicts_definition",
                name,
                "the value that its definition gives",
                name,
                "derived",
            )
    return found


def _contradicted_haste(trials: pl.DataFrame) -> list[Problem]:
    return broken(
        trials,
        pl.col("too_fast") != derive.TOO_FAST,
        "too_fast_contradicts_definition",
        "too_fast",
        "true if and only if stop_time_s is less than first_decision_s",
        "too_fast",
        "stop_time_s",
        "first_decision_s",
    )


_RULES: tuple[tuple[set[str], Callable[[pl.DataFrame], list[Problem]]], ...] = (
    ({"participant", "condition"}, _two_conditions),
    ({"guess", "goal", "correct"}, _contradicted_guess),
    ({"stop_time_s", "length_s"}, _stop_after_end),
    ({"stop_time_s", "length_s", "reached_end"}, _end_before_length),
    ({"stop_time_s", "length_s", "correct"}, _contradicted_measures),
    ({"first_decision_s", "length_s"}, _decision_after_end),
    ({"stop_time_s", "first_decision_s", "too_fast"}, _contradicted_haste),
)
"""Each rule with the columns it needs."""
