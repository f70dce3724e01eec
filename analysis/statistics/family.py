"""Several hypotheses tested at once."""

from __future__ import annotations

from collections.abc import Sequence


def holm(p: Sequence[float | None]) -> tuple[float | None, ...]:
    """Return the p values corrected for one another, in the same order; None stays None.

    A missing p is not counted as a hypothesis. Source: Holm (1979), step-down.
    """
    # not statsmodels' own, which collects garbage: longer than the rest of a small report
    rising = sorted((each, place) for place, each in enumerate(p) if each is not None)
    corrected, largest = list(p), 0.0
    for rank, (each, place) in enumerate(rising):
        largest = max(largest, min(1.0, (len(rising) - rank) * each))
        corrected[place] = largest
    return tuple(corrected)
