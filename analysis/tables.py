"""Writing and reading the export's tables.

A table is written as .csv, .jsonl and .parquet; reading back any of them yields equal frames.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import ExitStack
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import polars as pl

from .columns import Column, Kind, Table
from .errors import TableError
from .files import folder_for_writing, replacing
from .scanning import FORMATS, is_empty_jsonl, scan, typed
from .validation import ROW, column_problems, lacking, raise_first

_TIME_FORMAT = "%Y-%m-%dT%H:%M:%S%.6fZ"


def write_table(table: Table, rows: Iterable[Mapping[str, Any]], folder: Path) -> list[Path]:
    """Write rows as `folder`/<table's name>.csv, .parquet and .jsonl; return the three paths.

    Each row maps every column name of the table to its value (None if missing); times are
    `datetime`s that know their zone. The files appear under their names only when all three are
    complete. TableError: a column missing, unknown, or holding another type.
    """
    frame = frame_of(table, rows)
    as_text = frame.with_columns(
        pl.col(column.name).dt.strftime(_TIME_FORMAT)
        for column in table.columns
        if column.kind is Kind.TIME
    )
    paths = [folder / f"{table.name}{suffix}" for suffix in FORMATS]
    with folder_for_writing(folder), ExitStack() as stack:
        csv, parquet, jsonl = (stack.enter_context(replacing(path)) for path in paths)
        as_text.write_csv(csv)
        frame.write_parquet(parquet)
        as_text.write_ndjson(jsonl)
    return paths


def frame_of(table: Table, rows: Iterable[Mapping[str, Any]]) -> pl.DataFrame:
    """Return the rows as a frame with the table's schema; TableError as in `write_table`."""
    kept = list(rows)
    names = set(table.names)
    for number, row in enumerate(kept, start=1):
        if row.keys() != names:
            missing, unknown = sorted(names - row.keys()), sorted(row.keys() - names)
            got = f"{', '.join(missing) or 'none'} missing, {', '.join(unknown) or 'none'} unknown"
            raise TableError(table.name, "exactly the table's columns", got, row=number)
    return pl.DataFrame(
        [_series(table, column, [row[column.name] for row in kept]) for column in table.columns]
    )


def read_table(table: Table, path: Path) -> pl.DataFrame:
    """Read one file of the export, hold it to its contract and return it with `table.schema`.

    Columns that came later than the version that made the file are empty.
    TableError names file, row and column of the first problem and how many more there are.
    """
    frame = read_rows(table, path)
    return frame.drop(ROW)


def read_rows(table: Table, path: Path) -> pl.DataFrame:
    """Do as `read_table` and keep the column `ROW`, for checks against other tables."""
    empty = pl.DataFrame(schema={ROW: pl.Int64(), **table.schema})
    if is_empty_jsonl(path):
        return empty
    raw, names = scan(path)
    if missing := [name for name in table.always if name not in names]:
        raise lacking(path.name, missing, names)
    present = [column for column in table.columns if column.name in names]
    frame, problems = typed(raw, present, path)
    # a cell that could not be read is not missing as well
    unread = [problem.column for problem in problems]
    raise_first(path.name, problems + column_problems(frame, table, unread))
    return pl.concat([empty, frame], how="diagonal")


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
