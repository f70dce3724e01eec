"""Result files of a run: rows that are only ever appended, and beside them what the run was."""

import csv
import io
import json
import os
import platform
from collections.abc import Iterable, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

from policies.errors import ResultError

PACKAGES = ("goalguess", "numpy", "scipy", "numba", "joblib")
"""Distributions whose versions decide what a seed gives."""


class Store:
    """Rows of one run in `<name>.csv`; its parameters and versions in `<name>.json`.

    Existing files are gone on with only when `resume` says so, and only with the parameters,
    columns and versions they were begun with: ResultError else. What a killed run left of its
    last line is dropped then. `parameters` (the seed among them) must be JSON.
    """

    def __init__(
        self,
        folder: Path,
        name: str,
        parameters: Mapping[str, object],
        columns: Sequence[str],
        *,
        resume: bool = False,
    ) -> None:
        self.file = folder / f"{name}.csv"
        self.columns = tuple(columns)
        described = folder / f"{name}.json"
        run = _describe(parameters, columns)
        if described.exists() and resume:
            _expect_the_same(run, described)
        elif described.exists() or self.file.exists():
            raise ResultError(
                f"{self.file if self.file.exists() else described}: expected no results here, "
                "found those of another run; resume it, or name another folder"
            )
        else:
            folder.mkdir(parents=True, exist_ok=True)
            beside = described.with_suffix(".json.part")
            beside.write_text(json.dumps(run, indent=2) + "\n", encoding="utf-8")
            beside.replace(described)
        self._drop_half_a_line()

    def done(self, key_columns: Sequence[str]) -> set[tuple[str, ...]]:
        """The keys of all stored rows: their cells in `key_columns`, as text."""
        with self.file.open(newline="", encoding="utf-8") as file:
            return {tuple(row[column] for column in key_columns) for row in csv.DictReader(file)}

    def append(self, rows: Iterable[Mapping[str, object]]) -> None:
        """Add rows, each a cell for every column; all are on the disk when this returns."""
        lines = []
        for row in rows:
            if row.keys() != set(self.columns):
                raise ResultError(
                    f"{self.file}: expected cells for {', '.join(self.columns)}; "
                    f"came {', '.join(row)}"
                )
            lines.append([row[column] for column in self.columns])
        self._write(lines)

    def _write(self, lines: Iterable[Sequence[object]]) -> None:
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows(lines)
        with self.file.open("ab") as file:
            file.write(text.getvalue().encode())
            file.flush()
            os.fsync(file.fileno())

    def _drop_half_a_line(self) -> None:
        """Keep whole lines only, the first of them the header."""
        kept = self.file.read_bytes() if self.file.exists() else b""
        whole = kept.rfind(b"\n") + 1
        if whole < len(kept):
            os.truncate(self.file, whole)
        if not whole:
            self._write([self.columns])


def _describe(parameters: Mapping[str, object], columns: Sequence[str]) -> dict[str, Any]:
    """What `<name>.json` says of a run, as JSON reads it back."""
    versions = {"python": platform.python_version(), **{name: version(name) for name in PACKAGES}}
    run = {"parameters": dict(parameters), "columns": list(columns), "versions": versions}
    read_back: dict[str, Any] = json.loads(json.dumps(run))
    return read_back


def _expect_the_same(run: dict[str, Any], described: Path) -> None:
    """ResultError on the first entry in which a run differs from the one that was begun."""
    now = _flat(run)
    try:
        begun = _flat(json.loads(described.read_text(encoding="utf-8")))
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ResultError(f"{described}: expected the description of a run: {error!r}") from error
    for entry in {**begun, **now}:
        was, comes = begun.get(entry), now.get(entry)
        if was != comes:
            raise ResultError(f"{described}: expected {entry} {was} to resume, came {comes}")


def _flat(run: dict[str, Any]) -> dict[str, Any]:
    versions = {f"version of {name}": value for name, value in run["versions"].items()}
    return {**run["parameters"], "columns": run["columns"], **versions}
