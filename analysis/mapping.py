"""How a table from elsewhere writes what the contract of the trials calls otherwise.

A mapping is a small TOML file, for example:

    [columns]                  # name in the contract = name in the file
    participant = "subject"
    stop_time_s = "rt"

    [conditions]               # value in the file = condition of the plan
    "1" = "polmdp"

    [units]                    # of the columns of time; "s" unless said
    stop_time_s = "ms"

    [confidence]               # lowest and highest rating; 1 and 7 unless said
    low = 0
    high = 100
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import polars as pl

from .columns import Column
from .contract import TRIALS
from .errors import TableError, TomlError
from .toml_file import Section, content_sha256, read_toml

ALIASES = {
    "video": "scenario",
    "trial": "trial_index",
    "stop_time": "stop_time_s",
    "video_length": "length_s",
}
"""Names in tables from elsewhere that are understood without a mapping (times in s)."""

_SECTIONS = ("columns", "conditions", "units", "confidence")
_PER_SECOND = {"s": 1, "ms": 1000}
_TIMES = tuple(column.name for column in TRIALS.columns if column.unit == "s")
_CONFIDENCE = TRIALS.column("confidence")


@dataclass(frozen=True)
class TableMapping:
    """A checked mapping.

    `columns` maps names of the contract to the file's; `conditions` values of the file to
    conditions; `units` columns of time to "s" or "ms"; `confidence` has the lowest and the highest
    rating. `file` is where it was read from.
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    conditions: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    confidence: tuple[float, float] = (_CONFIDENCE.low or 0, _CONFIDENCE.high or 0)
    file: str = "no mapping"

    @property
    def content(self) -> dict[str, Any]:
        """What the mapping says, under the keys of its file."""
        low, high = self.confidence
        return {
            "columns": dict(self.columns),
            "conditions": dict(self.conditions),
            "units": dict(self.units),
            "confidence": {"low": low, "high": high},
        }

    @property
    def sha256(self) -> str:
        """Hash of the content, in hexadecimal."""
        return content_sha256(self.content)

    def sources(self, names: Sequence[str], file: str) -> dict[str, str]:
        """Return which of the file's columns `names` each column of the contract is read from.

        TomlError if a mapped column is not in the file, TableError if it has both names of one.
        """
        for ours, theirs in self.columns.items():
            if theirs not in names:
                found = f"{file} with columns {', '.join(names)}"
                raise TomlError(self.file, f"columns.{ours}", f"a file with column {theirs}", found)
        found_by_name = {name: name for name in names if name in TRIALS.names}
        aliased = {ALIASES[name]: name for name in names if name in ALIASES}
        for ours, theirs in aliased.items():
            if ours in found_by_name and ours not in self.columns:
                raise TableError(file, f"{theirs} or {ours}", "both columns", row=1)
        return {**found_by_name, **aliased, **self.columns}

    def declared(self, column: Column) -> Column:
        """Return the declaration of a column as this mapping changes it."""
        if column.name != _CONFIDENCE.name:
            return column
        low, high = self.confidence
        return replace(column, low=low, high=high)

    def translated(self, trials: pl.DataFrame) -> pl.DataFrame:
        """Return typed trials with the plan's conditions, and all times in seconds.

        TomlError if a condition of the mapping does not occur.
        """
        if self.conditions:
            found = trials["condition"].drop_nulls().unique().sort().to_list()
            for theirs in self.conditions:
                if theirs not in found:
                    expected = f"one of the conditions {', '.join(found)}"
                    raise TomlError(self.file, f"conditions.{theirs}", expected, repr(theirs))
        return trials.with_columns(
            pl.col("condition").replace(dict(self.conditions)),
            *(
                pl.col(name) / _PER_SECOND[unit]
                for name, unit in self.units.items()
                if name in trials.columns
            ),
        )


def read_mapping(path: Path) -> TableMapping:
    """Read a mapping; TomlError names file and key of the first thing that cannot be followed."""
    mapping = Section(path.name, read_toml(path))
    mapping.allow(_SECTIONS)
    columns, conditions, units = (mapping.section(name) for name in _SECTIONS[:3])
    columns.allow(TRIALS.names)
    units.allow(_TIMES)
    return TableMapping(
        columns={ours: columns.text(ours) for ours in columns.content},
        conditions={theirs: conditions.text(theirs) for theirs in conditions.content},
        units={name: units.choice(name, _PER_SECOND) for name in units.content},
        confidence=_scale(mapping.section("confidence")),
        file=path.name,
    )


def _scale(section: Section) -> tuple[float, float]:
    section.allow(("low", "high"))
    if not section.content:
        return TableMapping.confidence
    low, high = section.number("low"), section.number("high")
    if low >= high:
        raise section.wrong("high", f"a number above low = {low:g}", high)
    return low, high
