"""A report as Markdown."""

from __future__ import annotations

import re
from collections.abc import Sequence

from .document import Finding, Grid, Heading, Items, Paragraph, Part, Picture

_ELEMENT = re.compile(r"<(?=[A-Za-z/!?])")


def markdown(parts: Sequence[Part]) -> str:
    """Render as Markdown; pictures are links to figures/<name>.svg."""
    return "\n\n".join(_markdown(part) for part in parts) + "\n"


def _markdown(part: Part) -> str:
    match part:
        case Heading(text, level):
            return f"{'#' * level} {_text(text)}"
        case Paragraph(text):
            return _text(text)
        case Finding(verdict, text):
            return f"**{_text(verdict)}** {_text(text)}"
        case Items(texts):
            return "\n".join(f"- {_text(text)}" for text in texts)
        case Picture(name, caption, alt):
            return f"![{_text(alt)}](figures/{name}.svg)\n\n*{_text(caption)}*"
        case Grid(caption, header, rows):
            rule = ("---", *("---:" for _ in header[1:]))
            cells = [[_cell(text) for text in row] for row in (header, *rows)]
            lines = [cells[0], rule, *cells[1:]]
            table = "\n".join(f"| {' | '.join(line)} |" for line in lines)
            return f"*{_text(caption)}*\n\n{table}"


def _text(text: str) -> str:
    """Keep what looks like an element of HTML from becoming one."""
    return _ELEMENT.sub("&lt;", text)


def _cell(text: str) -> str:
    return " ".join(_text(text.replace("\\", "\\\\").replace("|", "\\|")).split())
