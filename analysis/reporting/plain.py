"""A report for the terminal."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from .document import NOTHING, Finding, Grid, Heading, Items, Paragraph, Part, Picture

_WIDTH = 88


def plain_text(parts: Sequence[Part]) -> str:
    """Render for the terminal: tables aligned, paragraphs wrapped, pictures left out."""
    text = "\n\n".join(_plain(part) for part in parts if not isinstance(part, Picture))
    # not every terminal has the sign
    return text.replace(NOTHING, "-") + "\n"


def _plain(part: Part) -> str:
    match part:
        case Heading(text, level):
            return f"{text}\n{('=' if level == 1 else '-') * len(text)}"
        case Paragraph(text):
            return _wrapped(text)
        case Finding(verdict, text):
            return f"{_wrapped(verdict)}\n{_wrapped(text, '  ')}"
        case Items(texts):
            return "\n".join(_wrapped(text, "- ") for text in texts)
        case Grid(caption, header, rows):
            table = [[" ".join(text.split()) for text in row] for row in (header, *rows)]
            widths = [max(map(len, column)) for column in zip(*table, strict=True)]
            lines = (_aligned(row, widths) for row in table)
            return "\n".join((_wrapped(caption), *lines))
        case Picture():
            return ""


def _wrapped(text: str, bullet: str = "") -> str:
    """Fill lines without parting a symbol from its number, so that `U = 177976` can be found."""
    for sign in "=<>":
        text = text.replace(f" {sign} ", f"\N{NO-BREAK SPACE}{sign}\N{NO-BREAK SPACE}")
    text = text.replace(" %", "\N{NO-BREAK SPACE}%")
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
