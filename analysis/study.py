"""From files to checked tables: an export folder, or one file of trials.

Two layouts are read. A file with all columns of `contract.TRIALS` (an older one lacks those that
came later) is an export of Goalguess and is held to the whole contract. Any other file is a table
of trials from elsewhere: it needs the columns of `NEEDED` (with `correct`, or `guess` and `goal`),
under these names, those of `mapping.ALIASES` or those that a mapping tells; its conditions have any
names; and it may have missing answers, which are counted and left out of the estimates that need
them.
"""

from __future__ import annotations

import hashlib
from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path

import polars as pl

from . import derive
from .columns import Table
from .contract import PARTICIPANTS, TRIALS
from .errors import AnalysisError, TableError
from .mapping import TableMapping
from .participant_rules import missing_times, participant_problems
from .scanning import FORMATS, is_empty_jsonl, scan, typed, unescaped
from .tables import read_rows
from .trial_rules import membership_problems, trial_problems
from .validation import (
    ROW,
    Oddity,
    column_problems,
    lacking,
    raise_first,
    without_odd_values,
)

NEEDED = (
    "participant",
    "condition",
    "scenario",
    "trial_index",
    "stop_time_s",
    "length_s",
    "confidence",
)
"""What an analysis needs, besides `correct` or else `guess` and `goal`."""

ANSWERS = (
    "goal",
    "guess",
    "correct",
    "stop_time_s",
    "length_s",
    "prediction_time_s",
    "score",
    "confidence",
)
"""What may be missing in a trial from elsewhere."""


@dataclass(frozen=True)
class Source:
    """A file that was read: its name, SHA-256 in hexadecimal, and number of rows."""

    file: str
    sha256: str
    rows: int


@dataclass(frozen=True)
class Study:
    """The checked tables of a study, whole; `participants` is None without such a table.

    Rows are in the order of participants and their trials, because the last digits of sums depend
    on the order. `renamed` pairs the file's column names with those of the contract; `exported` is
    whether Goalguess made the file of trials, whose times then count motion only. `recorded` names
    the columns that the file of participants has, and `oddities` what is odd in either file.
    """

    trials: pl.DataFrame
    participants: pl.DataFrame | None
    sources: tuple[Source, ...]
    renamed: tuple[tuple[str, str], ...]
    exported: bool
    oddities: tuple[Oddity, ...]
    recorded: tuple[str, ...] = ()


def read_study(path: Path, mapping: TableMapping) -> Study:
    """Read a study's files (.csv, .parquet, .jsonl) and hold them to their rules.

    TableError for the first broken rule, TomlError for a mapping that does not fit the file.
    """
    trials_path, participants_path = _find(path)
    trials, renamed, oddities = _read_trials(trials_path, mapping)
    alone = Study(
        trials=_in_order(trials, TRIALS),
        participants=None,
        sources=(_source(trials_path, trials),),
        renamed=renamed,
        exported=_is_export(trials.columns),
        oddities=oddities,
    )
    if participants_path is None:
        return alone
    read = read_rows(PARTICIPANTS, participants_path)
    people, file = read.frame, participants_path.name
    raise_first(file, participant_problems(people))
    raise_first(trials_path.name, membership_problems(trials, people, file))
    return replace(
        alone,
        participants=_in_order(people, PARTICIPANTS),
        sources=(*alone.sources, _source(participants_path, people)),
        oddities=(*oddities, *read.oddities, *missing_times(people, file)),
        recorded=read.recorded,
    )


def _find(path: Path) -> tuple[Path, Path | None]:
    """Return the file of trials and, in a folder that has one, the file of participants."""
    if path.is_file():
        return path, None
    if not path.is_dir():
        raise AnalysisError(f"{path}: expected an export folder or a file of trials, got nothing")
    trials = _in_any_format(path, TRIALS.name)
    if trials is None:
        wanted = " or ".join(f"{TRIALS.name}{suffix}" for suffix in FORMATS)
        raise AnalysisError(f"{path}: expected a folder with {wanted}, got one without")
    return trials, _in_any_format(path, PARTICIPANTS.name)


def _in_any_format(folder: Path, name: str) -> Path | None:
    candidates = (folder / f"{name}{suffix}" for suffix in FORMATS)
    return next((path for path in candidates if path.is_file()), None)


def _read_trials(
    path: Path, mapping: TableMapping
) -> tuple[pl.DataFrame, tuple[tuple[str, str], ...], tuple[Oddity, ...]]:
    """Return the trials, which columns have other names in the file, and what is odd in it."""
    if is_empty_jsonl(path):
        raise AnalysisError(f"{path.name}: expected at least one trial, got an empty file")
    raw, names = scan(path)
    sources = mapping.sources(names, path.name)
    _check_columns(path, names, sources)
    table = _table_of(mapping, sources)
    present = [column for column in table.columns if column.name in sources]
    raw = raw.select(ROW, *(pl.col(theirs).alias(ours) for ours, theirs in sources.items()))
    exported = _is_export(sources)
    trials, problems = typed(unescaped(raw, present, path) if exported else raw, present, path)
    if trials.is_empty():
        raise TableError(path.name, "at least one trial", "no rows")
    trials = mapping.translated(trials)
    unread = [problem.column for problem in problems]
    problems += column_problems(trials, table, [*unread, *(() if exported else ANSWERS)])
    trials, oddities = without_odd_values(trials, table, path.name)
    raise_first(path.name, problems + trial_problems(trials), sources)
    renamed = tuple((theirs, ours) for ours, theirs in sources.items() if theirs != ours)
    return _with_measures(trials), renamed, tuple(oddities)


def _is_export(columns: Collection[str]) -> bool:
    return set(columns) >= set(TRIALS.always)


def _table_of(mapping: TableMapping, columns: Collection[str]) -> Table:
    """Return the trials' contract as it binds this file: elsewhere conditions have other names."""
    declared = [mapping.declared(column) for column in TRIALS.columns]
    if not _is_export(columns):
        declared = [
            replace(column, choices=()) if column.name == "condition" else column
            for column in declared
        ]
    return replace(TRIALS, columns=tuple(declared))


def _check_columns(path: Path, names: list[str], present: Collection[str]) -> None:
    missing = [name for name in NEEDED if name not in present]
    if "correct" not in present and not {"guess", "goal"} <= set(present):
        missing.append("correct (or guess and goal)")
    if missing:
        raise lacking(path.name, missing, names)


def _with_measures(trials: pl.DataFrame) -> pl.DataFrame:
    """Fill in what was not recorded, by its definition."""
    if {"guess", "goal"} <= set(trials.columns):
        recorded = pl.col("correct") if "correct" in trials.columns else pl.lit(None, pl.Boolean)
        trials = trials.with_columns(correct=recorded.fill_null(derive.CORRECT))
    return trials.with_columns(prediction_time_s=derive.PREDICTION_TIME_S)


def _in_order(rows: pl.DataFrame, table: Table) -> pl.DataFrame:
    """Leave the file's order, which only errors tell, for that of the table's key."""
    return rows.drop(ROW).sort(table.key)


def _source(path: Path, rows: pl.DataFrame) -> Source:
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256")
    return Source(path.name, digest.hexdigest(), len(rows))
