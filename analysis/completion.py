"""Who finished the study."""

from __future__ import annotations

from dataclasses import dataclass

import polars as pl

from .contract import COMPLETED


@dataclass(frozen=True, eq=False)
class Completion:
    """Who finished, of all who have trials, and what it means to have finished or not.

    `people` has a row for each participant: participant, condition, trials (their number), done.
    """

    people: pl.DataFrame
    finished: str
    incomplete: str


def completion(trials: pl.DataFrame, participants: pl.DataFrame | None, planned: int) -> Completion:
    """Tell who finished.

    By the participants table, whoever has completed the study; without that table, whoever has the
    `planned` number of trials or, where nobody has, as many as the participant with most.
    """
    people = trials.group_by("participant", "condition").agg(trials=pl.len().cast(pl.Int64))
    if participants is not None:
        done = participants.select("participant", done=pl.col("status") == COMPLETED)
        people = people.join(done, on="participant", how="left")
        return Completion(people, "completed the study", "study not completed")
    most = people.select(pl.col("trials").max()).item()
    people = people.with_columns(done=pl.col("trials") >= min(planned, most))
    if most < planned:
        return Completion(
            people,
            "answered as many trials as anyone",
            f"fewer than {most} trials, the most that anyone has",
        )
    whole = f"the plan's {planned} trials"
    return Completion(people, f"answered {whole}", f"fewer than {whole}")
