"""Which numbers a text prints, and which a table can stand behind."""

import re
from collections.abc import Iterable

import polars as pl
import polars.selectors as cs

FORMATS = ("{:.3g}", "{:,.3g}", "{:.3f}", "{:.2f}", "{:.2g}", "{:g}", "{:,}")
"""The ways in which readings print a number."""


def printed_in(text: str, without: Iterable[str] = ()) -> set[str]:
    """The numbers of a text, signs apart, once the phrases `without` are taken out."""
    for phrase in without:
        assert phrase in text, f"{phrase!r} is said no more"
        text = text.replace(phrase, " ")
    return set(re.findall(r"\d+(?:,\d{3})*(?:\.\d+)?(?:e[-+]?\d+)?|\.\d+", text))


def printable(values: Iterable[float]) -> set[str]:
    """All that numbers may look like in a reading."""
    return {form.format(abs(value)) for value in values for form in FORMATS}


def numbers_of(*tables: pl.DataFrame) -> list[float]:
    """All numbers of the tables."""
    return [
        value
        for table in tables
        for column in table.select(cs.numeric())
        for value in column.drop_nulls()
    ]
