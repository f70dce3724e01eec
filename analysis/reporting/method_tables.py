"""Every method for one measure, in two tables: trials clustered, and trials as independent."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from ..methods import INDEPENDENT, Comparison, methods_of
from ..statistics.mixed_model import CrossedLogistic
from ..statistics.result import TestResult
from ..warning_texts import WARNINGS
from ..wording import capital, format_p
from .answers import WORDS
from .document import NOTHING, Grid, Heading, Items, Part, with_reason
from .effects import beyond, bracketed, estimate_cell, interval, statistic

PRIMARY = " (primary)"
"""What the primary test's name ends with."""

_CLUSTERED = "taking into account that trials of one participant resemble each other"
LACKING = "the method gives none, or a note below says why there is none"
"""Why a table of results may lack a number."""
HEADER = ("", "estimate", "95 % interval", "test", "p", "n")
"""Of `result_row`."""


def method_parts(compared: Comparison, alpha: float) -> list[Part]:
    """Return a measure's heading, its tables, and what is to be said of single methods."""
    words = WORDS[compared.measure]
    names = method_names(compared)
    name = capital(words.name)
    parts: list[Part] = [Heading(name, 3)]
    for caption, independent in (
        (f"{name}, {_CLUSTERED}", False),
        (f"{name}, trials taken as independent", True),
    ):
        keys = [key for key in compared.results if (key in INDEPENDENT) == independent]
        rows = (result_row(names[key], compared.results[key], alpha) for key in keys)
        parts += with_reason(Grid(caption, HEADER, tuple(rows)), LACKING)
    notes = tuple(_notes(compared, names))
    return [*parts, Items(notes)] if notes else parts


def method_names(compared: Comparison) -> dict[str, str]:
    """Return how each method is called, by its key; the primary test says that it is."""
    methods = methods_of(compared.measure, compared.primary_key, seed=0)
    return {
        key: method.name + PRIMARY if key == compared.primary_key else method.name
        for key, method in methods.items()
    }


def in_shares(model: CrossedLogistic) -> CrossedLogistic:
    """Put the difference of shares that the model implies in the place of its odds ratio."""
    return replace(
        model,
        estimate=model.risk_difference,
        low=model.risk_difference_low,
        high=model.risk_difference_high,
        unit="share",
        null=0.0,
    )


def p_cell(p: float | None, alpha: float) -> str:
    """Write a p value where the column already says p."""
    return NOTHING if p is None else format_p(p, alpha=alpha).removeprefix("p ").removeprefix("= ")


def result_row(name: str, result: TestResult, alpha: float) -> tuple[str, ...]:
    """Write a result as a row of a table."""
    has_test = result.p is not None or result.warnings
    return (
        name,
        estimate_cell(result),
        interval(result),
        statistic(result),
        p_cell(result.p, alpha) if has_test else "",
        f"{result.n:,}",
    )


def _notes(compared: Comparison, names: dict[str, str]) -> Iterable[str]:
    for key, result in compared.results.items():
        for code in result.warnings:
            yield f"{names[key]}: {WARNINGS[code]}."
        if outside := beyond(result):
            yield f"{names[key]}: {outside}."
        if isinstance(result, CrossedLogistic) and result.risk_difference is not None:
            told = bracketed(in_shares(result))
            yield f"{names[key]}: the same in shares, as forests show it, {told}."
    for key, reason in compared.left_out.items():
        yield f"{names[key]}: left out, {reason}."
