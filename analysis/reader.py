"""From an export folder, or one file of trials, to checked data.

Two layouts are read. A file with all columns of `contract.TRIALS` (an older one lacks those that
came later) is an export of Goalguess and is held to the whole contract. Any other file is a table
of trials from elsewhere: it needs the columns of `NEEDED` (with `correct`, or `guess` and `goal`),
may use the names of `ALIASES`, and may have missing answers, which are counted and left out of the
estimates that need them.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

import polars as pl

from .contract import CONDITIONS, PARTICIPANTS, TRIALS
from .derive import correct_guesses, prediction_times_s
from .errors import AnalysisError, EmptyArmError, TableError
from .participant_rules import participant_problems
from .scanning import FORMATS, is_empty_jsonl, scan, typed
from .tables import read_rows
from .trial_rules import membership_problems, trial_problems
from .validation import ROW, column_problems, raise_first

ALIASES = {
    "video": "scenario",
    "trial": "trial_index",
    "stop_time": "stop_time_s",
    "video_length": "length_s",
}
"""Names in tables from elsewhere, and the names of the contract they stand for (times in s)."""

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
class Dataset:
    """Checked data. `trials` has the columns of the contract that its file has, and always
    participant, condition, scenario, trial_index, correct, prediction_time_s and confidence;
    the last three are null where missing. `participants` is None without such a table.

    `simulated` and `preview` count trials so marked: left out, or analysed if `with_simulated`.
    `renamed` pairs the file's column names with those of the contract.
    """

    trials: pl.DataFrame
    participants: pl.DataFrame | None
    sources: tuple[Source, ...]
    simulated: int
    preview: int
    with_simulated: bool
    renamed: tuple[tuple[str, str], ...]


def read_dataset(path: Path, *, with_simulated: bool = False) -> Dataset:
    """Read an export folder or one file of trials (.csv, .parquet, .jsonl) and check it.

    Rows of simulated and preview participants are left out unless `with_simulated`.
    TableError for the first broken rule, EmptyArmError for a condition without trials.
    """
    trials_path, participants_path = _find(path)
    rows, renamed = _read_trials(trials_path)
    sources = [_source(trials_path, rows)]
    trials = rows if with_simulated else _only_real(rows)
    participants = None
    if participants_path is not None:
        everyone = read_rows(PARTICIPANTS, participants_path)
        raise_first(participants_path.name, participant_problems(everyone))
        sources.append(_source(participants_path, everyone))
        participants = everyone if with_simulated else _only_real(everyone)
        raise_first(trials_path.name, membership_problems(rows, everyone, participants_path.name))
        participants = participants.drop(ROW)
    _check_arms(rows, trials)
    return Dataset(
        trials=trials.drop(ROW),
        participants=participants,
        sources=tuple(sources),
        simulated=_count(rows, "simulated"),
        preview=_count(rows, "preview"),
        with_simulated=with_simulated,
        renamed=renamed,
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


def _read_trials(path: Path) -> tuple[pl.DataFrame, tuple[tuple[str, str], ...]]:
    if is_empty_jsonl(path):
        raise AnalysisError(f"{path.name}: expected at least one trial, got an empty file")
    raw, names = scan(path)
    renamed = tuple((name, ALIASES[name]) for name in names if name in ALIASES)
    for name, meant in renamed:
        if meant in names:
            raise TableError(path.name, f"{name} or {meant}", "both columns", row=1)
    raw = raw.rename(dict(renamed))
    present = {ALIASES.get(name, name) for name in names}
    _check_columns(path, names, present)
    columns = [column for column in TRIALS.columns if column.name in present]
    trials, problems = typed(raw, columns, path)
    unread = [problem.column for problem in problems]
    optional = [*unread, *(() if present >= set(TRIALS.always) else ANSWERS)]
    problems += column_problems(trials, TRIALS, optional) + trial_problems(trials)
    raise_first(path.name, problems, {meant: name for name, meant in renamed})
    return _with_measures(trials), renamed


def _check_columns(path: Path, names: list[str], present: set[str]) -> None:
    missing = [name for name in NEEDED if name not in present]
    if "correct" not in present and not {"guess", "goal"} <= present:
        missing.append("correct (or guess and goal)")
    if missing:
        raise TableError(path.name, f"columns {', '.join(missing)}", ", ".join(names), row=1)


def _with_measures(trials: pl.DataFrame) -> pl.DataFrame:
    """Fill in what was not recorded, by its definition."""
    if {"guess", "goal"} <= set(trials.columns):
        derived = correct_guesses(trials["guess"], trials["goal"]).alias("derived")
        recorded = pl.col("correct") if "correct" in trials.columns else pl.lit(None, pl.Boolean)
        trials = trials.with_columns(recorded.fill_null(derived).alias("correct"))
    times = prediction_times_s(trials["stop_time_s"], trials["length_s"], trials["correct"])
    return trials.with_columns(times.alias("prediction_time_s"))


def _only_real(rows: pl.DataFrame) -> pl.DataFrame:
    marks = [pl.col(name) for name in ("simulated", "preview") if name in rows.columns]
    return rows.filter(~pl.any_horizontal(marks)) if marks else rows


def _count(rows: pl.DataFrame, mark: str) -> int:
    return int(rows[mark].sum()) if mark in rows.columns else 0


def _check_arms(rows: pl.DataFrame, trials: pl.DataFrame) -> None:
    left_out = len(rows) - len(trials)
    note = f" ({left_out} simulated or preview trials left out)" if left_out else ""
    for condition in CONDITIONS:
        if trials.filter(pl.col("condition") == condition).is_empty():
            raise EmptyArmError(condition, "trial", note)


def _source(path: Path, rows: pl.DataFrame) -> Source:
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256")
    return Source(path.name, digest.hexdigest(), len(rows))
