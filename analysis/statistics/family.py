"""Several hypotheses tested at once."""

from __future__ import annotations

from collections.abc import Sequence


def holm(p: Sequence[float | None]) -> tuple[float | None, ...]:
    """Return the p values corrected for one another, in the same order; None stays None.

    A missing p is not counted as a hypothesis. Source: Holm (1979), step-down.
    """
    from statsmodels.stats.multitest import multipletests

    present = [each for each in p if each is not None]
    if not present:
        return tuple(p)
    corrected = iter(multipletests(present, method="holm")[1].tolist())
    return tuple(None if each is None else next(corrected) for each in p)
