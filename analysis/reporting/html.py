"""A report as one HTML file that needs nothing else: no script, no font, no other file."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from html import escape
from importlib import resources

from .document import Finding, Grid, Heading, Items, Paragraph, Part, Picture
from .inline_svg import inline_svg

_WHOLE = re.compile(
    r"[^\s<>=(]+(?:\([^)]*\))? (?:=|&lt;|&gt;) [^\s,;)]+"  # a symbol and its number
    r"|\d[\d.]* %|\[[^\]]+\]"  # a percentage, an interval
)
"""What no line may part."""


def html(parts: Sequence[Part], drawings: Mapping[str, str]) -> str:
    """Render as a page; `drawings` has the SVG of every picture by its name."""
    title = next(part.text for part in parts if isinstance(part, Heading) and part.level == 1)
    style = resources.files(__package__).joinpath("report.css").read_text(encoding="utf-8")
    body = "\n".join(_html(part, drawings) for part in parts)
    head, rest = body.split("</h1>", 1)
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>\n{style}</style>\n</head>\n"
        f"<body>\n<main>\n{head}</h1>\n{_contents(parts)}{rest}\n</main>\n</body>\n</html>\n"
    )


def _contents(parts: Sequence[Part]) -> str:
    links = (
        f'<li><a href="#{_anchor(part.text)}">{escape(part.text)}</a></li>'
        for part in parts
        if isinstance(part, Heading) and part.level == 2
    )
    return f'<nav aria-label="Contents">\n<ul>\n{chr(10).join(links)}\n</ul>\n</nav>'


def _html(part: Part, drawings: Mapping[str, str]) -> str:
    match part:
        case Heading(text, 2):
            return f'<h2 id="{_anchor(text)}">{_text(text)}</h2>'
        case Heading(text, level):
            return f"<h{level}>{_text(text)}</h{level}>"
        case Paragraph(text):
            return f"<p>{_text(text)}</p>"
        case Finding(verdict, text):
            return f'<p class="finding"><strong>{_text(verdict)}</strong> {_text(text)}</p>'
        case Items(texts):
            return f"<ul>\n{chr(10).join(f'<li>{_text(text)}</li>' for text in texts)}\n</ul>"
        case Grid():
            return _table(part)
        case Picture(name, caption, alt):
            drawing = inline_svg(drawings[name], name, alt)
            return f"<figure>\n{drawing}\n<figcaption>{_text(caption)}</figcaption>\n</figure>"


def _table(grid: Grid) -> str:
    """A table that scrolls inside itself, by keyboard too, where it is wider than the screen."""
    header = "".join(
        f'<th scope="col">{_text(text)}</th>' if text else "<td></td>" for text in grid.header
    )
    rows = (
        f'<tr><th scope="row">{_text(first)}</th>'
        + "".join(f"<td>{_text(text)}</td>" for text in others)
        + "</tr>"
        for first, *others in grid.rows
    )
    return (
        f'<div class="wide" role="region" aria-label="{escape(grid.caption)}" tabindex="0">\n'
        f"<table>\n<caption><span>{_text(grid.caption)}</span></caption>\n"
        f"<thead><tr>{header}</tr></thead>\n<tbody>\n{chr(10).join(rows)}\n</tbody>\n"
        "</table>\n</div>"
    )


def _text(text: str) -> str:
    return _WHOLE.sub(r'<span class="whole">\g<0></span>', escape(text, quote=False))


def _anchor(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")
