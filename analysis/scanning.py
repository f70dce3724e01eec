"""From a file to a typed frame: what values look like in CSV, JSON lines and Parquet."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Sequence
from pathlib import Path

import polars as pl

from .columns import Column, Kind
from .errors import AnalysisError, TableError
from .spreadsheet import from_spreadsheet_text
from .validation import ROW, Problem

FORMATS = (".csv", ".parquet", ".jsonl")
"""In the order in which a reader looks for them: CSV is the one people open and mend."""

_FILLED = " filled"
_LARGEST_EXACT = 2.0**53
_OTHER_SEPARATORS = {";": "semicolons", "\t": "tabs"}
_WORDS = {"true": True, "1": True, "false": False, "0": False}


def scan(path: Path) -> tuple[pl.LazyFrame, list[str]]:
    """Open a table lazily; return it with the column `ROW` added, and its own column names.

    The cells of CSV and JSON lines stay text. Rows count as in a spreadsheet (a CSV's header is
    row 1; empty rows count but are left out); in JSON lines the first line is row 1.
    """
    if not path.is_file():
        raise AnalysisError(f"{path}: expected a file, got nothing there to read")
    try:
        if path.suffix == ".csv":
            names, first_row = _csv_header(path), 2
            raw = pl.scan_csv(path, infer_schema=False)
        elif path.suffix == ".jsonl":
            names, first_row = _jsonl_keys(path), 1
            raw = pl.scan_ndjson(path, schema=dict.fromkeys(names, pl.String()))
        elif path.suffix == ".parquet":
            names, first_row = list(pl.read_parquet_schema(path)), 2
            raw = pl.scan_parquet(path)
        else:
            raise TableError(
                path.name, f"a file ending in {', '.join(FORMATS)}", path.suffix or "no ending"
            )
    except (OSError, ValueError, csv.Error, pl.exceptions.PolarsError) as error:
        raise _unreadable(path, error) from error
    numbered = raw.with_row_index(ROW, offset=first_row)
    return numbered.filter(~pl.all_horizontal(pl.col(names).is_null())), names


def unescaped(raw: pl.LazyFrame, columns: Sequence[Column], path: Path) -> pl.LazyFrame:
    """Give the texts of an export of ours back as they were before they went into a CSV."""
    if path.suffix != ".csv":
        return raw
    return raw.with_columns(
        from_spreadsheet_text(pl.col(column.name)) for column in columns if column.is_text
    )


def is_empty_jsonl(path: Path) -> bool:
    """Tell whether this is a table without rows; JSON lines have no header that would say so."""
    return path.suffix == ".jsonl" and path.is_file() and path.stat().st_size == 0


def typed(
    raw: pl.LazyFrame, columns: Sequence[Column], path: Path
) -> tuple[pl.DataFrame, list[Problem]]:
    """Turn the cells of `columns` into their declared types.

    Returns the frame (with `ROW`; a cell that cannot be converted is null) and one problem for
    each column that has such cells.
    """
    asked = []
    try:
        found = raw.collect_schema()
        for column in columns:
            filled, value = _conversion(column, found[column.name])
            asked += [value.alias(column.name), filled.alias(column.name + _FILLED)]
        frame = raw.select(pl.col(ROW).cast(pl.Int64), *asked).collect(engine="streaming")
    except pl.exceptions.PolarsError as error:
        raise _unreadable(path, error) from error
    problems = []
    for column in columns:
        bad = frame[column.name + _FILLED] & frame[column.name].is_null()
        rows = frame[ROW].filter(bad).to_list()
        if rows:
            cell = raw.filter(pl.col(ROW) == rows[0]).select(column.name).collect().item()
            problems.append(Problem("wrong_type", column.name, column.expected, rows, repr(cell)))
    return frame.select(ROW, *(column.name for column in columns)), problems


def _conversion(column: Column, found: pl.DataType) -> tuple[pl.Expr, pl.Expr]:
    """Return two expressions: whether the cell holds something, and its value or null."""
    cell = pl.col(column.name)
    if found == column.dtype and column.kind is not Kind.NUMBER:
        value = cell.replace("", None) if found == pl.String else cell
        return value.is_not_null(), value
    if found.is_numeric() and column.kind is Kind.NUMBER:
        return cell.is_not_null(), _finite(cell.cast(pl.Float64))
    text = cell.cast(pl.String, strict=False)
    if column.kind in (Kind.TEXT, Kind.JSON):
        return text.is_not_null(), text.replace("", None)
    text = text.str.strip_chars()
    # R writes NA for a missing value; a text column keeps it, it may be the code of Namibia
    filled = text.is_not_null() & ~text.is_in(["", "NA"])
    number = text.cast(pl.Float64, strict=False)
    whole = (number == number.floor()) & (number.abs() < _LARGEST_EXACT)
    values = {
        Kind.NUMBER: _finite(number),
        Kind.INTEGER: text.cast(pl.Int64, strict=False).fill_null(
            pl.when(whole).then(number).cast(pl.Int64, strict=False)
        ),
        Kind.BOOLEAN: text.str.to_lowercase().replace_strict(
            _WORDS, default=None, return_dtype=pl.Boolean
        ),
        Kind.TIME: text.str.to_datetime("%+", time_unit="us", time_zone="UTC", strict=False),
    }
    return filled, values[column.kind]


def _finite(number: pl.Expr) -> pl.Expr:
    return pl.when(number.is_finite()).then(number)


def _csv_header(path: Path) -> list[str]:
    with path.open(encoding="utf-8-sig", newline="") as file:
        names = next(csv.reader(file), [])
    repeated = sorted({name for name in names if names.count(name) > 1})
    if not names or repeated:
        got = f"{', '.join(repeated)} more than once" if repeated else "an empty file"
        raise TableError(path.name, "a header of different column names", got, row=1)
    for separator, called in _OTHER_SEPARATORS.items():
        if len(names) == 1 and separator in names[0]:
            expected = "column names separated by commas"
            raise TableError(path.name, expected, f"them separated by {called}", row=1)
    return names


def _jsonl_keys(path: Path) -> list[str]:
    with path.open(encoding="utf-8") as file:
        first = json.loads(file.readline() or "{}")
    if not isinstance(first, dict) or not first:
        raise TableError(path.name, "a JSON object", f"{str(first)[:40]!r}", row=1)
    return list(first)


def _unreadable(path: Path, error: Exception) -> TableError:
    """Say where a file cannot be read; polars does not tell the row, so look for it."""
    try:
        if path.suffix != ".parquet" and (not_utf8 := _first_row_not_in_utf8(path)):
            return not_utf8
        if path.suffix == ".csv":
            return _first_ragged_row(path)
        if path.suffix == ".jsonl":
            return _first_broken_line(path)
    except (OSError, ValueError, LookupError, csv.Error):
        pass
    reason = str(error).splitlines()[0] if str(error) else type(error).__name__
    if isinstance(error, OSError):
        reason = error.strerror or reason
    return TableError(path.name, f"a readable {path.suffix} file in UTF-8", reason)


def _first_row_not_in_utf8(path: Path) -> TableError | None:
    with path.open(encoding="utf-8-sig", errors="surrogateescape", newline="") as file:
        rows = csv.reader(file) if path.suffix == ".csv" else file
        for number, row in enumerate(rows, start=1):
            if escaped := re.search("[\udc80-\udcff]", "".join(row)):
                got = f"byte 0x{ord(escaped[0]) - 0xDC00:02x}; save the table as UTF-8"
                return TableError(path.name, "characters in UTF-8", got, row=number)
    return None


def _first_ragged_row(path: Path) -> TableError:
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = csv.reader(file)
        width = len(next(rows))
        for number, cells in enumerate(rows, start=2):
            if len(cells) > width:
                return TableError(
                    path.name, f"{width} cells as in the header", str(len(cells)), row=number
                )
    raise LookupError("every row fits the header")


def _first_broken_line(path: Path) -> TableError:
    with path.open(encoding="utf-8") as file:
        for number, line in enumerate(file, start=1):
            try:
                json.loads(line)
            except ValueError as error:
                return TableError(path.name, "one JSON object", str(error), row=number)
    raise LookupError("every line is JSON")
