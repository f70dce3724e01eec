"""Writing and reading the export's tables.

A table is written as .csv, .jsonl and .parquet; reading back any of them yields equal frames.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import polars as pl

from .columns import Column, Kind, Table
from .errors import TableError
from .files import folder_for_writing, replacing
from .scanning import FORMATS, is_empty_jsonl, scan, typed, unescaped
from .spreadsheet import as_spreadsheet_text
from .validation import (
    ROW,
    Oddity,
    column_problems,
    lacking,
    raise_first,
    without_odd_values,
)

_TIME_FORMAT = "%Y-%m-%dT%H:%M:%S%.6fZ"
_BATCH = 5_000
"""Rows in memory at once."""

Rows = Iterable[Mapping[str, Any]]


@dataclass(frozen=True, eq=False)
class TableRead:
    """A table as read: typed, with `ROW`, and all columns of its declaration.

    `recorded` names the columns that the file has, `oddities` what it holds that must not be.
    """

    frame: pl.DataFrame
    recorded: tuple[str, ...]
    oddities: tuple[Oddity, ...] = ()


def write_table(table: Table, rows: Rows, folder: Path) -> list[Path]:
    """Write rows as `folder`/<table's name>.csv, .parquet and .jsonl; return the three paths.

    Each row maps every column name of the table to its value (None if missing); times are
    `datetime`s that know their zone. The files appear under their names only when all three are
    complete. TableError: a column missing, unknown, or holding another type.
    """
    return write_tables([(table, rows)], folder)


def write_tables(tables: Iterable[tuple[Table, Rows]], folder: Path) -> list[Path]:
    """Do as `write_table` to several, one after the other; all files appear, or none does.

    Rows are taken a few thousand at a time, so that no table needs to fit into memory.
    """
    with folder_for_writing(folder), ExitStack() as stack:
        return [path for table, rows in tables for path in _write(table, rows, folder, stack)]


def _write(table: Table, rows: Rows, folder: Path, stack: ExitStack) -> list[Path]:
    paths = [folder / f"{table.name}{suffix}" for suffix in FORMATS]
    csv, parquet, jsonl = (stack.enter_context(replacing(path)) for path in paths)
    with (
        csv.open("wb") as as_csv,
        jsonl.open("wb") as as_jsonl,
        TemporaryDirectory(prefix=f".{table.name}.", dir=folder) as made,
    ):
        for number, frame in enumerate(_frames(table, rows)):
            text = frame.with_columns(
                pl.col(column.name).dt.strftime(_TIME_FORMAT)
                for column in table.columns
                if column.kind is Kind.TIME
            )
            escaped = text.with_columns(
                as_spreadsheet_text(pl.col(column.name))
                for column in table.columns
                if column.is_text
            )
            escaped.write_csv(as_csv, include_header=number == 0)
            text.write_ndjson(as_jsonl)
            # Nothing appends to Parquet, so its rows wait in parts.
            frame.write_parquet(Path(made) / f"{number:09d}.parquet")
        pl.scan_parquet(sorted(Path(made).iterdir())).sink_parquet(parquet)
    return paths


def _frames(table: Table, rows: Rows) -> Iterator[pl.DataFrame]:
    """Return the rows as frames with the table's schema, one without rows if there are none."""
    left, done = iter(rows), 0
    while True:
        batch = list(islice(left, _BATCH))
        if batch or not done:
            yield frame_of(table, batch, done + 1)
        done += len(batch)
        if len(batch) < _BATCH:
            return


def frame_of(table: Table, rows: Sequence[Mapping[str, Any]], first: int = 1) -> pl.DataFrame:
    """Return rows as a frame with the table's schema; errors name the first one as row `first`.

    TableError as in `write_table`.
    """
    names = set(table.names)
    for number, row in enumerate(rows, start=first):
        if row.keys() != names:
            missing, unknown = sorted(names - row.keys()), sorted(row.keys() - names)
            got = f"{', '.join(missing) or 'none'} missing, {', '.join(unknown) or 'none'} unknown"
            raise TableError(table.name, "exactly the table's columns", got, row=number)
    return pl.DataFrame(
        [_series(table, column, [row[column.name] for row in rows]) for column in table.columns]
    )


def read_table(table: Table, path: Path) -> pl.DataFrame:
    """Read one file of the export, hold it to its contract and return it with `table.schema`.

    Columns that came later than the version that made the file are empty, and so is what lenient
    columns must not hold.
    TableError names file, row and column of the first problem and how many more there are.
    """
    return read_rows(table, path).frame.drop(ROW)


def read_rows(table: Table, path: Path) -> TableRead:
    """Do as `read_table`; also return what is odd, and the rows' numbers for further checks."""
    empty = pl.DataFrame(schema={ROW: pl.Int64(), **table.schema})
    if is_empty_jsonl(path):
        return TableRead(empty, table.names)
    raw, names = scan(path)
    if missing := [name for name in table.always if name not in names]:
        raise lacking(path.name, missing, names)
    present = [column for column in table.columns if column.name in names]
    frame, problems = typed(unescaped(raw, present, path), present, path)
    # a cell that could not be read is not missing as well
    unread = [problem.column for problem in problems]
    raise_first(path.name, problems + column_problems(frame, table, unread))
    frame, oddities = without_odd_values(frame, table, path.name)
    whole = pl.concat([empty, frame], how="diagonal")
    return TableRead(whole, tuple(column.name for column in present), tuple(oddities))


def _series(table: Table, column: Column, values: list[Any]) -> pl.Series:
    """Return one column of values in its declared type; TableError for one of another type."""
    if column.kind is Kind.TIME:
        values = [_in_utc(table, column, value) for value in values]
    if column.kind in (Kind.TEXT, Kind.JSON):
        values = [None if value == "" else value for value in values]
    try:
        return pl.Series(column.name, values, dtype=column.dtype, strict=True)
    except (TypeError, ValueError, OverflowError, pl.exceptions.PolarsError) as error:
        reason = str(error).splitlines()[0]
        raise TableError(table.name, column.expected, reason, column=column.name) from error


def _in_utc(table: Table, column: Column, value: object) -> datetime | None:
    if value is None:
        return None
    if not isinstance(value, datetime) or value.tzinfo is None:
        got = f"{value!r}, which is no time with a zone"
        raise TableError(table.name, column.expected, got, column=column.name)
    return value.astimezone(UTC)
