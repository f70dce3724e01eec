"""A report as a list of parts, written once and rendered as HTML, Markdown or for the terminal."""

from __future__ import annotations

from dataclasses import dataclass

NOTHING = "–"
"""In a table, where a number does not exist."""


@dataclass(frozen=True)
class Heading:
    """A heading; level 1 is the title."""

    text: str
    level: int = 2


@dataclass(frozen=True)
class Paragraph:
    """Running text."""

    text: str


@dataclass(frozen=True)
class Finding:
    """An answer: what was found in a few words, then the numbers it rests on."""

    verdict: str
    text: str


@dataclass(frozen=True)
class Items:
    """Points of a list."""

    texts: tuple[str, ...]


@dataclass(frozen=True)
class Grid:
    """A table; the first column names the rows and is set left, numbers are set right.

    A cell may have several lines, which only HTML keeps apart.
    """

    caption: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Picture:
    """A figure by the stem of its file in figures/, with a text for who does not see it."""

    name: str
    caption: str
    alt: str


Part = Heading | Paragraph | Finding | Items | Grid | Picture


def with_reason(grid: Grid, reason: str) -> list[Part]:
    """Return a table and, if it lacks a number, a line that says why."""
    if not any(NOTHING in cell for _, *cells in grid.rows for cell in cells):
        return [grid]
    return [grid, Paragraph(f"{NOTHING}: {reason}.")]
