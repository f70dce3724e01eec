"""A drawing made fit to stand inside a page."""

from __future__ import annotations

import re
from html import escape

_OUTSIDE = re.compile(r"<\?xml.*?\?>|<!DOCTYPE.*?>|<metadata>.*?</metadata>|<!--.*?-->", re.DOTALL)
_OPENING = re.compile(r"<svg\b[^>]*>")
_SIZE = re.compile(r'\s(?:width|height|version|xmlns(?::\w+)?)="[^"]*"')
_REFERENCE = re.compile(r'(\bid="|xlink:href="#|url\(#)')


def inline_svg(svg: str, name: str, alt: str) -> str:
    """Return the SVG element of a file for a page, told to those who do not see it as `alt`.

    It takes the width it is given; its ids begin with `name`, so that they are the page's only
    ones; what only a file of its own needs is left out.
    """
    drawing = _OUTSIDE.sub("", svg).strip()
    drawing = _REFERENCE.sub(rf"\g<1>{name}-", drawing).replace("xlink:href", "href")
    opening = _OPENING.search(drawing)
    if opening is None:
        raise ValueError(f"{name}: expected an SVG, got {svg[:40]!r}")
    described = f'{_SIZE.sub("", opening[0])[:-1]} role="img" aria-label="{escape(alt)}">'
    return described + drawing[opening.end() :]
