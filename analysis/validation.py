"""Rules a table must keep beyond the types of its cells; every break names row and column."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import polars as pl

from .columns import Column, Kind, Table
from .errors import TableError

ROW = "row"
"""Extra column of frames under validation: where the row stands in its file."""


@dataclass(frozen=True)
class Problem:
    """One kind of break in one column: `rows` has them all, `got` is what the first one holds."""

    code: str
    column: str
    expected: str
    rows: Sequence[int]
    got: str


@dataclass(frozen=True)
class Oddity:
    """What is odd in so many rows of a file and refuses nothing; `code` is that of its notice."""

    code: str
    file: str
    column: str
    rows: int


def raise_first(
    file: str, problems: Sequence[Problem], names: Mapping[str, str] | None = None
) -> None:
    """Raise the problem in the earliest row as a TableError that counts the others.

    `names` maps columns of the contract to what the file calls them, where that differs.
    """
    if not problems:
        return
    first = min(problems, key=lambda problem: problem.rows[0])
    raise TableError(
        file,
        first.expected,
        first.got,
        row=first.rows[0],
        column=(names or {}).get(first.column, first.column),
        further=sum(len(problem.rows) for problem in problems) - 1,
    )


def lacking(file: str, missing: Sequence[str], names: Sequence[str]) -> TableError:
    """Return the error that tells which columns a file lacks; `names` are those it has."""
    noun = "column" if len(missing) == 1 else "columns"
    return TableError(file, f"{noun} {', '.join(missing)}", ", ".join(names), row=1)


def broken(
    frame: pl.DataFrame, breaks: pl.Expr, code: str, column: str, expected: str, *shown: str
) -> list[Problem]:
    """Return the problem of the rows for which `breaks` is true, or nothing.

    `shown` names the columns whose values tell what was got (default: `column` itself).
    """
    bad = frame.filter(breaks)
    if bad.is_empty():
        return []
    first = bad.row(0, named=True)
    names = shown or (column,)
    values = [_shown(first[name]) for name in names]
    pairs = zip(names, values, strict=True)
    got = ", ".join(f"{name} {value}" for name, value in pairs) if shown else values[0]
    return [Problem(code, column, expected, bad[ROW].to_list(), got)]


def column_problems(
    frame: pl.DataFrame, table: Table, optional: Collection[str] = ()
) -> list[Problem]:
    """Hold a typed frame with `ROW` to its table: missing cells, allowed values, the key.

    Only columns in the frame are looked at; `optional` ones may be empty like nullable ones, and
    what lenient ones must not hold is for `without_odd_values`.
    """
    found: list[Problem] = []
    for column in table.columns:
        if column.name not in frame.columns:
            continue
        if not column.nullable and column.name not in optional:
            found += broken(
                frame, pl.col(column.name).is_null(), "missing", column.name, column.expected
            )
        breaks = _outside(column)
        if breaks is not None and not column.lenient:
            found += broken(frame, breaks, "not_allowed", column.name, column.expected)
    repeated = ~pl.struct(table.key).is_first_distinct()
    complete = pl.all_horizontal(pl.col(table.key).is_not_null())
    found += broken(
        frame,
        repeated & complete,
        "duplicate",
        table.key[-1],
        f"each {' and '.join(table.key)} once",
        *table.key,
    )
    return found


def without_odd_values(
    frame: pl.DataFrame, table: Table, file: str
) -> tuple[pl.DataFrame, list[Oddity]]:
    """Empty the cells of lenient columns that hold what they must not, and return which did."""
    odd = {
        column.name: breaks
        for column in table.columns
        if column.lenient and column.name in frame.columns
        if (breaks := _outside(column)) is not None
    }
    if not odd:
        return frame, []
    counts = frame.select(breaks.sum().alias(name) for name, breaks in odd.items()).row(0)
    found = [
        Oddity("values_emptied", file, name, count)
        for name, count in zip(odd, counts, strict=True)
        if count
    ]
    emptied = (pl.when(~breaks).then(name).alias(name) for name, breaks in odd.items())
    return frame.with_columns(emptied), found


def _outside(column: Column) -> pl.Expr | None:
    """Return an expression that is true where a value lies outside of what is allowed."""
    cell = pl.col(column.name)
    if column.choices:
        return ~cell.is_in(column.choices)
    if column.letter:
        return ~cell.str.contains(r"^[A-Z]$")
    if column.kind is Kind.JSON:
        return ~cell.map_elements(_is_json, return_dtype=pl.Boolean)
    bounds = [
        test
        for limit, test in (
            (column.low, cell < (column.low or 0)),
            (column.high, cell > (column.high or 0)),
            (column.above, cell <= (column.above or 0)),
        )
        if limit is not None
    ]
    return pl.any_horizontal(bounds) if bounds else None


def _is_json(text: str) -> bool:
    try:
        json.loads(text)
    except ValueError:
        return False
    return True


def _shown(value: object) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value) if isinstance(value, str) else str(value)
