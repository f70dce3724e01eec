"""How an estimate is printed: by its unit, odds and hazards as ratios."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..statistics.result import TestResult
from ..wording import Write, decimals_of_interval, format_p, without_zero
from .document import NOTHING

_LARGEST_LOG = 700.0
_MANY_DIGITS = 1000
_PRINTED = 3
"""Decimals that are printed of an AUC, and of a share (one, as a percentage)."""


@dataclass(frozen=True)
class Effect:
    """What an estimate in some unit is called, and how its value is written, without the unit."""

    name: str
    unit: str
    write: Write

    def in_words(self, value: float, more: int = 0) -> str:
        """Write a value as running text has it: odds ratio = 2.70, difference = 2.50 s."""
        return f"{self.name} = {self.with_unit(value, more)}"

    def in_cell(self, value: float, more: int = 0) -> str:
        """Write a value as short as can be understood: odds ratio 2.70, 2.50 s."""
        return (
            self.with_unit(value, more) if self.unit else f"{self.name} {self.write(value, more)}"
        )

    def with_unit(self, value: float, more: int = 0) -> str:
        """Write a value with its unit, if it has one; `more` decimals than usual."""
        return f"{self.write(value, more)} {self.unit}".rstrip()


def _percentage(value: float, more: int = 0) -> str:
    return f"{100 * value:z.{1 + more}f}"


def _amount(value: float, more: int = 0) -> str:
    return f"{value:z.{2 + more}f}"


def _ratio(value: float, more: int = 0) -> str:
    return f"{value:.3g}" if value >= _MANY_DIGITS else f"{value:.{2 + more}f}"


def _ratio_of_log(value: float, more: int = 0) -> str:
    return _ratio(math.exp(min(value, _LARGEST_LOG)), more)


def _coefficient(value: float, more: int = 0) -> str:
    return without_zero(value, 3 + more)


EFFECTS = {
    "share": Effect("difference", "percentage points", _percentage),
    "s": Effect("difference", "s", _amount),
    "scale points": Effect("difference", "scale points", _amount),
    "probability": Effect("AUC", "", _coefficient),
    "phi": Effect("phi", "", _coefficient),
    "correlation": Effect("correlation", "", _coefficient),
    "odds ratio": Effect("odds ratio", "", _ratio),
    "log odds": Effect("odds ratio", "", _ratio_of_log),
    "log odds ratio": Effect("odds ratio", "", _ratio_of_log),
    "log hazard ratio": Effect("hazard ratio", "", _ratio_of_log),
}
"""By the unit of a `TestResult`."""


def effect_of(result: TestResult) -> Effect:
    """Return how the estimate of a result is written."""
    return EFFECTS[result.unit]


def decimals_beside(result: TestResult) -> int:
    """Return how many decimals more than usual the interval, and what stands beside it, need."""
    return decimals_of_interval(result.low, result.high, result.null, effect_of(result).write)


def value(result: TestResult, more: int | None = None) -> str:
    """Write the estimate without name and unit, or a dash; `more` decimals if it is told."""
    if result.estimate is None:
        return NOTHING
    more = decimals_beside(result) if more is None else more
    return effect_of(result).write(result.estimate, more)


def estimate(result: TestResult) -> str:
    """Write the estimate with its name: odds ratio = 2.70."""
    effect = effect_of(result)
    if result.estimate is None:
        return f"{effect.name} not defined"
    return effect.in_words(result.estimate, decimals_beside(result))


def estimate_cell(result: TestResult) -> str:
    """Write the estimate for a table: odds ratio 2.70, or a dash."""
    if result.estimate is None:
        return NOTHING
    return effect_of(result).in_cell(result.estimate, decimals_beside(result))


def interval(result: TestResult, between: str = " to ", more: int | None = None) -> str:
    """Write the bounds of the 95 % interval: 9.5 to 21.1, or a dash; `more` decimals if told."""
    if result.low is None or result.high is None:
        return NOTHING
    more = decimals_beside(result) if more is None else more
    return between.join(effect_of(result).write(each, more) for each in (result.low, result.high))


def beyond(result: TestResult) -> str:
    """Say that the interval as printed reaches where no estimate can be; else empty."""
    if result.unit == "probability":
        least, possible = 0, "0 to 1, where every AUC lies"
    elif result.unit == "share" and result.null == 0:
        least, possible = -1, "-100 to 100 percentage points, where every difference lies"
    elif result.unit == "share":
        least, possible = 0, "0 to 100 %, where every share lies"
    else:
        return ""
    if result.low is None or result.high is None:
        return ""
    decimals = _PRINTED + decimals_beside(result)
    low, high = round(result.low, decimals), round(result.high, decimals)
    if least <= low <= high <= 1:
        return ""
    return f"the interval reaches outside {possible}, and is not cut"


def statistic(result: TestResult) -> str:
    """Write the statistic with its degrees of freedom: t(36) = 5.32."""
    if result.statistic is None:
        return ""
    return f"{result.symbol}{_degrees(result)} = {_number(result)}"


def statement(result: TestResult, alpha: float) -> str:
    """Write statistic and p: t(36) = 5.32, p < .001."""
    return ", ".join(filter(None, (statistic(result), format_p(result.p, alpha=alpha))))


def statement_cell(result: TestResult, alpha: float) -> str:
    """Write statistic and p for a table, or a dash."""
    return NOTHING if result.p is None else statement(result, alpha)


def bracketed(result: TestResult) -> str:
    """Write estimate and interval as APA has them: AUC = .349, 95 % CI [.310, .388]."""
    if result.low is None or result.high is None:
        return estimate(result)
    return f"{estimate(result)}, 95 % CI [{interval(result, ', ')}]"


def _degrees(result: TestResult) -> str:
    if result.df is None:
        return ""
    if isinstance(result.df, tuple):
        return f"({', '.join(f'{df:g}' for df in result.df)})"
    whole = float(result.df).is_integer()
    return f"({result.df:.0f})" if whole else f"({result.df:.1f})"


def _number(result: TestResult) -> str:
    value = result.statistic or 0.0
    if result.symbol == "chi2":
        return f"{value:.3f}"
    return f"{value:.0f}" if result.symbol == "U" else f"{value:z.2f}"
