"""A report as a list of parts, written once and rendered as Markdown or for the terminal."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

_WIDTH = 88


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
class Items:
    """Points of a list."""

    texts: tuple[str, ...]


@dataclass(frozen=True)
class Grid:
    """A table; the first column names the rows and is set left, numbers are set right."""

    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Picture:
    """A figure by its path relative to the report, with a text for who does not see it."""

    file: str
    alt: str


Part = Heading | Paragraph | Items | Grid | Picture


def markdown(parts: Sequence[Part]) -> str:
    """Render as Markdown."""
    return "\n\n".join(_markdown(part) for part in parts) + "\n"


def plain_text(parts: Sequence[Part]) -> str:
    """Render for the terminal: tables aligned, paragraphs wrapped, pictures left out."""
    return "\n\n".join(_plain(part) for part in parts if not isinstance(part, Picture)) + "\n"


def _markdown(part: Part) -> str:
    match part:
        case Heading(text, level):
            return f"{'#' * level} {text}"
        case Paragraph(text):
            return text
        case Items(texts):
            return "\n".join(f"- {text}" for text in texts)
        case Picture(file, alt):
            return f"![{alt}]({file})"
        case Grid(header, rows):
            rule = ("---", *("---:" for _ in header[1:]))
            cells = [[_cell(text) for text in row] for row in (header, *rows)]
            lines = [cells[0], rule, *cells[1:]]
            return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _cell(text: str) -> str:
    return " ".join(text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;").split())


def _plain(part: Part) -> str:
    match part:
        case Heading(text, level):
            return f"{text}\n{('=' if level == 1 else '-') * len(text)}"
        case Paragraph(text):
            return _wrapped(text)
        case Items(texts):
            return "\n".join(_wrapped(text, "- ") for text in texts)
        case Grid(header, rows):
            table = [[" ".join(text.split()) for text in row] for row in (header, *rows)]
            widths = [max(map(len, column)) for column in zip(*table, strict=True)]
            return "\n".join(_aligned(row, widths) for row in table)
        case Picture():
            return ""


def _wrapped(text: str, bullet: str = "") -> str:
    """Fill lines without parting a symbol from its number, so that `U = 177976` can be found."""
    for sign in "=<>":
        text = text.replace(f" {sign} ", f"\N{NO-BREAK SPACE}{sign}\N{NO-BREAK SPACE}")
    lines = textwrap.fill(
        text,
        _WIDTH,
        initial_indent=bullet,
        subsequent_indent=" " * len(bullet),
        break_long_words=False,
        break_on_hyphens=False,
    )
    return lines.replace("\N{NO-BREAK SPACE}", " ")


def _aligned(row: Sequence[str], widths: Sequence[int]) -> str:
    first, *others = (
        text.ljust(width) if place == 0 else text.rjust(width)
        for place, (text, width) in enumerate(zip(row, widths, strict=True))
    )
    return "  ".join([first, *others]).rstrip()
