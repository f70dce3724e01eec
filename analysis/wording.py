"""Numbers as they are printed: APA style, never a p of .000."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from .statistics.estimates import LEVEL
from .statistics.normality import Normality
from .statistics.ranks import MannWhitney
from .statistics.two_by_two import ChiSquare

ALPHA = 0.05

_OF_INTERVALS = round(1 - LEVEL, 12)
"""The p at which an interval begins to exclude the null value."""

_MOST_DECIMALS = 12
"""More than these tell apart what rounding in the computation does not."""


class Write(Protocol):
    """How numbers of a kind are written."""

    def __call__(self, value: float, more: int = 0, /) -> str:
        """Write a number with the usual decimals and `more`."""


def format_p(p: float | None, relation: str = "=", alpha: float = ALPHA) -> str:
    """Write a p value with three decimals, with more where rounding would carry it over a level.

    The levels are `alpha` and that of all intervals, which may stand beside p. Below .001 and above
    .999 it is a bound, None is NA; `relation` is "<=" or ">=" where p itself is one.
    """
    if p is None:
        return "p = NA"
    if p < 0.001:
        return "p < .001"
    if p >= 0.9995:
        return "p > .999"
    decimals = 3
    while any((p < level) != (round(p, decimals) < level) for level in (alpha, _OF_INTERVALS)):
        decimals += 1
    return f"p {relation} {without_zero(p, decimals)}"


def more_decimals(rising: Sequence[tuple[float, float]], write: Write) -> int:
    """Return how many more decimals it takes to print the first of each pair below its second."""
    for more in range(_MOST_DECIMALS):
        if all(float(write(low, more)) < float(write(high, more)) for low, high in rising):
            return more
    return _MOST_DECIMALS


def decimals_of_interval(low: float | None, high: float | None, null: float, write: Write) -> int:
    """Return how many decimals more an interval needs to exclude `null` as printed, if it does.

    One that holds it needs none: rounding carries no bound over.
    """
    if low is None or high is None:
        return 0
    return more_decimals([pair for pair in ((null, low), (high, null)) if pair[0] < pair[1]], write)


def format_alpha(alpha: float) -> str:
    """Write a level of significance with all its decimals: .05."""
    return f"{alpha:g}".removeprefix("0")


def without_zero(value: float, decimals: int) -> str:
    """Write a number that cannot exceed 1 without its leading zero, as APA asks."""
    return f"{value:z.{decimals}f}".replace("0.", ".", 1)


def format_u(u: float) -> str:
    """Write a U as a whole number, with the half that ties may leave."""
    return f"{u:.0f}" if u == int(u) else f"{u:.1f}"


def percent(share: float, more: int = 0) -> str:
    """Write a share as a percentage with one decimal, and `more`."""
    return f"{100 * share:.{1 + more}f} %"


def chi_square_statistic(test: ChiSquare) -> str:
    """Write the statistic with its degrees of freedom: chi2(1) = 48.864."""
    return f"chi2({test.df}) = {'NA' if test.statistic is None else format(test.statistic, '.3f')}"


def chi_square_apa(test: ChiSquare) -> str:
    """Write the test in one line: chi2(1) = 48.864, p < .001, N = 1500, phi = .180."""
    phi = "NA" if test.estimate is None else without_zero(test.estimate, 3)
    return f"{chi_square_statistic(test)}, {format_p(test.p)}, N = {test.n}, phi = {phi}"


def mann_whitney_apa(test: MannWhitney) -> str:
    """Write the test in one line, with the smaller U as the paper prints it and the treatment's."""
    z = "NA" if test.statistic is None else f"{test.statistic:z.2f}"
    return (
        f"U = {format_u(test.u_smaller)}, {format_p(test.p)}, z = {z}, "
        f"n = {test.n_treatment} and {test.n_reference}, "
        f"rank-biserial r = {without_zero(test.rank_biserial, 3)} "
        f"(U of the treatment = {format_u(test.u_treatment)})"
    )


def normality_apa(test: Normality) -> str:
    """Write the test in one line: W or A2, and p."""
    if test.statistic is None:
        return f"{test.method}: not defined, n = {test.n}"
    p = format_p(test.p, test.p_relation)
    return f"{test.method}: {test.symbol} = {test.statistic:.4f}, {p}, n = {test.n}"


def words_of_test(test: str) -> str:
    """Write the name of a test in words: two-way AUC for two_way_auc."""
    words = test.replace("two_way", "two-way").replace("_", " ")
    return words.replace("auc", "AUC").replace("cox", "Cox")


def capital(text: str) -> str:
    """Write a text as the beginning of a sentence."""
    return text[:1].upper() + text[1:]
