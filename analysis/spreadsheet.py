"""Texts that a spreadsheet would run as formulas: harmless in CSV, and read back as they were.

A text that begins with =, +, -, @, a tab or a line's end, apostrophes before it or none, gets one
apostrophe more; every other text stays as it is. So the reader knows whose apostrophe it meets.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from polars import Expr

_FORMULA = r"'*[=+\-@\t\r\n]"
"""Beginnings of cells that spreadsheets run. Source: OWASP, CSV Injection."""


def spreadsheet_text(text: str) -> str:
    """Return a text as it goes into a cell of a CSV file."""
    return f"'{text}" if re.match(_FORMULA, text) else text


def as_spreadsheet_text(cell: Expr) -> Expr:
    """Do as `spreadsheet_text` to a column of texts."""
    return cell.str.replace(f"^({_FORMULA})", "'$1")


def from_spreadsheet_text(cell: Expr) -> Expr:
    """Undo `spreadsheet_text` in a column of texts."""
    return cell.str.replace(f"^'({_FORMULA})", "$1")
