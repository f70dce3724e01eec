"""Rules by which participants are left out: none is active unless the plan names it.

Each rule is a function of its parameters that gives one polars expression: whether a participant
is left out, seen over all rows of theirs in the rule's table. Whoever is taken by several rules
counts for the first.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import polars as pl

from .contract import PARTICIPANTS, TRIALS
from .errors import TomlError


@dataclass(frozen=True)
class Exclusion:
    """A rule that the plan makes active: its name in `RULES`, and its parameters."""

    rule: str
    parameters: Mapping[str, float]

    @property
    def reason(self) -> str:
        """What is said of those it takes, as in: answered fewer than 10 trials."""
        return RULES[self.rule].reason.format(**self.parameters)


@dataclass(frozen=True)
class Excluded:
    """Whom an active rule took: participants with trials that no earlier rule took."""

    exclusion: Exclusion
    participants: tuple[str, ...]


@dataclass(frozen=True)
class Rule:
    """What a rule takes, the reason that reports give, and the types of its parameters.

    `usual` gives their values where a rule is tried that the plan does not use, for the number of
    trials that each participant should have.
    """

    takes: Callable[..., pl.Expr]
    reason: str
    parameters: Mapping[str, type] = field(default_factory=dict)
    usual: Callable[[int], Mapping[str, float]] = lambda _planned: {}
    table: str = TRIALS.name


def incomplete(fewer_than: int) -> pl.Expr:
    """Too few trials answered."""
    return pl.len() < fewer_than


def too_fast_trials(at_least: int) -> pl.Expr:
    """Too many stops before the robot's first decision could be seen."""
    return pl.col("too_fast").sum() >= at_least


def same_guess() -> pl.Expr:
    """One area guessed all along, in two trials or more."""
    guesses = pl.col("guess")
    return (guesses.count() == pl.len()) & (pl.len() > 1) & (guesses.n_unique() == 1)


def never_moved_pointer() -> pl.Expr:
    """No sign of mouse, finger or pen in any trial; takes whoever plays by keyboard, too."""
    return pl.col("pointer_moved").eq_missing(False).all()


def long_pauses(above_s: float) -> pl.Expr:
    """Animations stood still for too long, because the page was hidden."""
    return pl.col("paused_s").sum() > above_s


def duplicate_stimuli() -> pl.Expr:
    """A scenario came twice; within a condition each has one stimulus."""
    return pl.col("scenario").n_unique() < pl.len()


def failed_control_question(tries_above: int) -> pl.Expr:
    """Too many answers until the control question was passed."""
    return pl.col("control_tries").max() > tries_above


def impossible_time() -> pl.Expr:
    """A trial, or all together, took less time than the motion that was watched by their times."""
    return pl.col("impossible_time").any()


RULES = {
    "incomplete": Rule(
        incomplete,
        "answered fewer than {fewer_than} trials",
        {"fewer_than": int},
        lambda planned: {"fewer_than": planned},
    ),
    "too_fast_trials": Rule(
        too_fast_trials,
        "stopped too fast in {at_least} trials or more",
        {"at_least": int},
        lambda _planned: {"at_least": 3},
    ),
    "same_guess": Rule(same_guess, "guessed the same area in all trials"),
    "never_moved_pointer": Rule(never_moved_pointer, "never moved the pointer"),
    "long_pauses": Rule(
        long_pauses,
        "paused for more than {above_s:g} s in all",
        {"above_s": float},
        lambda _planned: {"above_s": 60.0},
    ),
    "duplicate_stimuli": Rule(duplicate_stimuli, "saw a scenario more than once"),
    "failed_control_question": Rule(
        failed_control_question,
        "needed more tries than {tries_above} for the control question",
        {"tries_above": int},
        lambda _planned: {"tries_above": 1},
        PARTICIPANTS.name,
    ),
    "impossible_time": Rule(impossible_time, "sent times that cannot be", table=PARTICIPANTS.name),
}
"""Every rule that a plan may name."""


def exclude(
    exclusions: Sequence[Exclusion],
    trials: pl.DataFrame,
    participants: pl.DataFrame | None,
    plan_file: str,
) -> tuple[Excluded, ...]:
    """Run the active rules in their order on all who have trials.

    TomlError, naming the rule's place in `plan_file`, where a table or column it needs is missing.
    """
    left = trials.select(pl.col("participant").unique())
    excluded = []
    for place, exclusion in enumerate(exclusions, start=1):
        if missing := _missing(exclusion, trials, participants):
            wanted = f"{_columns(exclusion, missing)} for {exclusion.rule}"
            raise TomlError(plan_file, f"exclusions[{place}].rule", wanted, "none")
        found = taken(exclusion, trials, participants)
        out = left.join(found, on="participant", how="semi")["participant"].sort()
        left = left.join(out.to_frame(), on="participant", how="anti")
        excluded.append(Excluded(exclusion, tuple(out)))
    return tuple(excluded)


def taken(
    exclusion: Exclusion, trials: pl.DataFrame, participants: pl.DataFrame | None
) -> pl.DataFrame:
    """Return, in the column participant, all whom one rule takes; the tables have its columns."""
    takes = RULES[exclusion.rule].takes(**exclusion.parameters)
    rows = _rows(exclusion, trials, participants)
    return rows.group_by("participant").agg(takes.alias("taken")).filter("taken")


def cannot_be_applied(
    exclusion: Exclusion, trials: pl.DataFrame, participants: pl.DataFrame | None
) -> str:
    """Say which column a rule needs and finds missing or empty; else return an empty text."""
    if missing := _missing(exclusion, trials, participants):
        return f"there is no {_columns(exclusion, missing).removeprefix('the ')}"
    rows = _rows(exclusion, trials, participants)
    empty = [name for name in _needed(exclusion) if rows[name].null_count() == len(rows)]
    return f"{_columns(exclusion, empty)} is empty" if empty else ""


def _missing(
    exclusion: Exclusion, trials: pl.DataFrame, participants: pl.DataFrame | None
) -> list[str]:
    has = _rows(exclusion, trials, participants).columns
    return [name for name in _needed(exclusion) if name not in has]


def _needed(exclusion: Exclusion) -> list[str]:
    takes = RULES[exclusion.rule].takes(**exclusion.parameters)
    return sorted(set(takes.meta.root_names()))


def _rows(
    exclusion: Exclusion, trials: pl.DataFrame, participants: pl.DataFrame | None
) -> pl.DataFrame:
    """Return the rule's table, without any column where there is none."""
    if RULES[exclusion.rule].table == TRIALS.name:
        return trials
    return pl.DataFrame() if participants is None else participants


def _columns(exclusion: Exclusion, names: Sequence[str]) -> str:
    return f"the column {', '.join(names)} in the table {RULES[exclusion.rule].table}"
