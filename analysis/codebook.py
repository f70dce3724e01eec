"""The code book: the contract of the export as a Markdown text."""

from .columns import Column, Table
from .contract import TABLES

_INTRODUCTION = """\
# Code book

Each table comes as `.csv` (UTF-8, comma-separated), `.jsonl` (one JSON object per line) and
`.parquet`; all three hold the same values. Times of day are the server's, in UTC, written as
ISO 8601 (`2025-03-01T09:30:00.000000Z`). A missing value is an empty cell in CSV and `null`
elsewhere; an empty text counts as missing.

Texts are exported as they came, but for those that a spreadsheet would run as a formula: in CSV
alone, a text that begins with `=`, `+`, `-`, `@`, a tab or the end of a line, after any number of
apostrophes, has one apostrophe more in front (`'=1+1` stands for `=1+1`). Whoever reads the CSV
by a program takes it off again, as `goalguess analyse` does; numbers never have one.
"""


def code_book() -> str:
    """Return the code book of all tables as Markdown: meaning, type, unit and range of columns."""
    return "\n".join([_INTRODUCTION, *(_section(table) for table in TABLES)])


def _section(table: Table) -> str:
    lines = [
        f"## {table.name}",
        "",
        f"{table.meaning} Unique by: {', '.join(table.key)}.",
        "",
        "| column | meaning | type | unit | allowed values | may be empty |",
        "|---|---|---|---|---|---|",
        *(_row(column) for column in table.columns),
        "",
    ]
    return "\n".join(lines)


def _row(column: Column) -> str:
    cells = (
        f"`{column.name}`",
        column.meaning,
        column.kind,
        column.unit,
        column.allowed,
        "yes" if column.nullable else "no",
    )
    return f"| {' | '.join(cells)} |"
