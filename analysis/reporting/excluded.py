"""What stands beside "no difference shown": what can be excluded, and how probable the rest is."""

from __future__ import annotations

from ..arms import Arms
from ..conclusions import Conclusion
from ..methods import Comparison
from ..statistics.equivalence import Equivalence
from ..statistics.superiority import Superiority
from ..wording import format_alpha, format_p, more_decimals
from .effects import EFFECTS


def excluded(conclusion: Conclusion, compared: Comparison, arms: Arms) -> list[str]:
    """Say what a test that shows no difference excludes; nothing of any other."""
    if conclusion.direction != "none":
        return []
    if conclusion.equivalence is None:
        said = [
            f"The plan names no smallest effect of interest in {conclusion.primary.unit}, so "
            "nothing is said of what can be excluded."
        ]
    else:
        said = [_excluded(conclusion.equivalence)]
    if compared.superiority is not None:
        said.append(_probable(compared.superiority, arms))
    return said


def _excluded(found: Equivalence) -> str:
    can = "is excluded" if found.excluded else "cannot be excluded"
    p = format_p(found.p, alpha=found.alpha)
    return (
        f"{_effects_from(found)} {can} (two one-sided tests at "
        f"alpha = {format_alpha(found.alpha)}, of this measure alone: {p}; "
        f"{100 * found.level:g} % interval {_interval(found)})."
    )


def _effects_from(found: Equivalence) -> str:
    """Name the effects that were tested."""
    size = found.smallest_effect
    if found.unit == "probability":
        below, above = (format_alpha(found.null + far) for far in (-size, size))
        return f"An AUC of {below} or less, or of {above} or more,"
    named = (
        f"{100 * size:g} percentage points" if found.unit == "share" else f"{size:g} {found.unit}"
    )
    return f"A difference of {named} or more either way"


def _interval(found: Equivalence) -> str:
    """Write the interval so that, as printed, it reaches the effects exactly if it does."""
    write = EFFECTS[found.unit].write
    inside = (
        (found.null - found.smallest_effect, found.low),
        (found.high, found.null + found.smallest_effect),
    )
    more = more_decimals([pair for pair in inside if pair[0] < pair[1]], write)
    return f"{write(found.low, more)} to {write(found.high, more)}"


def _probable(found: Superiority, arms: Arms) -> str:
    probability = format_p(found.probability).removeprefix("p ")
    return (
        f"Posterior probability of a larger share of correct guesses with {arms.treatment.label} "
        f"{probability} ({found.method}, scenarios left out of account; priors: {found.priors})."
    )
