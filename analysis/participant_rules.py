"""Rules between the cells of the participants table, and what an honest row may lack."""

from __future__ import annotations

import polars as pl

from .contract import COMPLETED
from .validation import Oddity, Problem, broken

_PAGES = ("about_you_s", "instructions_s", "practice_s", "trials_s")
"""In the order in which participants come to them."""

_LEAST_TRIALS = {"never_moved_pointer": 1, "same_guess": 2, "same_confidence": 2}
"""Answered trials without which a sign says nothing."""


def participant_problems(participants: pl.DataFrame) -> list[Problem]:
    """Return what contradicts itself among the participants; the frame is typed and has `ROW`."""
    found = broken(
        participants,
        pl.col("too_fast_trials") > pl.col("trials_answered"),
        "more_than_answered",
        "too_fast_trials",
        "no more than trials_answered",
        "too_fast_trials",
        "trials_answered",
    )
    for name, least in _LEAST_TRIALS.items():
        found += broken(
            participants,
            pl.col(name).is_not_null() & (pl.col("trials_answered") < least),
            "says_too_much",
            name,
            f"nothing with trials_answered below {least}",
            name,
            "trials_answered",
        )
    found += broken(
        participants,
        pl.col("trials_s").is_not_null() & (pl.col("status") != COMPLETED),
        "trials_not_completed",
        "trials_s",
        f"nothing unless status is {COMPLETED}",
        "trials_s",
        "status",
    )
    return found


def missing_times(participants: pl.DataFrame, file: str) -> list[Oddity]:
    """Return the times of pages that are empty although a later page was finished.

    So it is where the server's clock was set back meanwhile.
    """
    finished = {page: pl.col(page).is_not_null() for page in _PAGES}
    # An older export has none of the times.
    timed = pl.any_horizontal(finished.values())
    later = timed & (pl.col("status") == COMPLETED)
    found = []
    for page in reversed(_PAGES):
        rows = participants.filter(later & ~finished[page]).height
        if rows:
            found.append(Oddity("times_missing", file, page, rows))
        later |= finished[page]
    return found[::-1]
