"""What a column and a table are: one declaration gives schema, validation and code book."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from polars.datatypes import DataType


class Kind(StrEnum):
    """What the cells of a column hold; the value is how the code book and errors name it."""

    TEXT = "text"
    JSON = "JSON text"
    INTEGER = "whole number"
    NUMBER = "number"
    BOOLEAN = "true or false"
    TIME = "UTC time"


@dataclass(frozen=True)
class Column:
    """One column: what it means, in which unit, and which values it may hold.

    `low` and `high` are inclusive, `above` is an exclusive lower bound, `choices` lists all
    values of a text column, `letter` asks for one of A-Z. `nullable` columns may be empty; an
    empty text is a missing value, in every file format. `later` columns came after the first
    exports were made: a file without them is as good, and is read as if they were empty. `lenient`
    columns describe how somebody took part, and no test hangs on them: a value outside of what is
    allowed is read as if it were empty, and told, where any other column refuses the file.
    """

    name: str
    kind: Kind
    meaning: str
    unit: str = ""
    low: float | None = None
    high: float | None = None
    above: float | None = None
    choices: tuple[str, ...] = ()
    letter: bool = False
    nullable: bool = False
    later: bool = False
    lenient: bool = False

    @property
    def is_text(self) -> bool:
        """Whether the cells are texts, which a spreadsheet may take for formulas."""
        return self.kind in (Kind.TEXT, Kind.JSON)

    @property
    def dtype(self) -> DataType:
        """Type of the column in a polars frame."""
        import polars as pl

        types: dict[Kind, DataType] = {
            Kind.TEXT: pl.String(),
            Kind.JSON: pl.String(),
            Kind.INTEGER: pl.Int64(),
            Kind.NUMBER: pl.Float64(),
            Kind.BOOLEAN: pl.Boolean(),
            Kind.TIME: pl.Datetime("us", "UTC"),
        }
        return types[self.kind]

    @property
    def allowed(self) -> str:
        """Allowed values in words, empty when the kind says everything."""
        if self.choices:
            return " or ".join(self.choices)
        if self.letter:
            return "one letter A-Z"
        if self.above is not None:
            return f"above {self.above:g}"
        if self.low is not None and self.high is not None:
            return f"from {self.low:g} to {self.high:g}"
        if self.low is not None:
            return f"{self.low:g} or more"
        return ""

    @property
    def expected(self) -> str:
        """What an error message says was expected: the kind with its allowed values."""
        if self.choices or self.letter:
            return self.allowed
        return f"{self.kind} {self.allowed}".strip()


@dataclass(frozen=True)
class Table:
    """One table of the export: `name` is its file's stem, `key` names what makes a row unique."""

    name: str
    meaning: str
    key: tuple[str, ...]
    columns: tuple[Column, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns, in the order of the file."""
        return tuple(column.name for column in self.columns)

    @property
    def always(self) -> tuple[str, ...]:
        """Names of the columns that every export has, whichever version made it."""
        return tuple(column.name for column in self.columns if not column.later)

    @property
    def schema(self) -> dict[str, DataType]:
        """Polars schema: column name to data type, in the order of the file."""
        return {column.name: column.dtype for column in self.columns}

    def column(self, name: str) -> Column:
        """Return the declaration of one column; KeyError if the table has none of that name."""
        for column in self.columns:
            if column.name == name:
                return column
        raise KeyError(name)
