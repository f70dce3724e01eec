"""Who finished the study."""

from __future__ import annotations

import polars as pl

from .contract import COMPLETED


def completion(trials: pl.DataFrame, participants: pl.DataFrame | None) -> tuple[pl.DataFrame, str]:
    """Return one row for each participant with trials, and what being incomplete means.

    The columns are participant, condition, trials (their number) and done. Done is, by the
    participants table, whoever has completed the study; without that table, whoever has as many
    trials as the participant with most.
    """
    each = trials.group_by("participant", "condition").agg(trials=pl.len().cast(pl.Int64))
    if participants is None:
        most = each.select(pl.col("trials").max()).item()
        return each.with_columns(done=pl.col("trials") == most), f"fewer than {most} trials"
    done = participants.select("participant", done=pl.col("status") == COMPLETED)
    return each.join(done, on="participant", how="left"), "study not completed"
