"""The demographics table: who answered what, per condition and over all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import polars as pl

from .dataset import Dataset
from .regions import NOT_RECOGNISED, NOT_TOLD, SEVERAL, world_region
from .statistics.estimates import Mean, mean

OVERALL = "overall"
"""The group of everybody, beside the conditions."""

QUESTIONS = ("gender", "nationality", "education", "occupation", "robot_familiarity")
"""Questions answered by a choice or a word; age, a number, is described apart."""

NO_ANSWER = "no answer"

_LAST = {SEVERAL: 1, NOT_RECOGNISED: 2, NOT_TOLD: 3}
"""What is listed after the regions, in this order, however frequent it is."""


@dataclass(frozen=True)
class Answer:
    """One answer to a question: `counts` per condition and `OVERALL`."""

    answer: str
    counts: dict[str, int]


@dataclass(frozen=True)
class Demographics:
    """Answers of the participants whose trials are analysed.

    `n` has the participants per condition and `OVERALL`; `age` their age in years, None for a
    group in which nobody told it; `regions` are the world regions of the nationalities told;
    `answers` lists each question's answers, most frequent first.
    """

    n: dict[str, int]
    age: dict[str, Mean | None]
    regions: tuple[Answer, ...]
    answers: dict[str, tuple[Answer, ...]]


def demographics(data: Dataset) -> Demographics | None:
    """Describe the participants whose trials are analysed; None without their table."""
    if data.participants is None:
        return None
    people = data.participants.join(
        data.trials.select("participant").unique(), on="participant", how="semi"
    )
    groups = {arm: people.filter(pl.col("condition") == arm) for arm in data.arms.names}
    groups[OVERALL] = people
    return Demographics(
        n={name: len(group) for name, group in groups.items()},
        age={name: _age(group) for name, group in groups.items()},
        regions=_regions(groups),
        answers={
            question: _counted(
                {
                    name: group[question].fill_null(NO_ANSWER).to_list()
                    for name, group in groups.items()
                }
            )
            for question in QUESTIONS
        },
    )


def _age(group: pl.DataFrame) -> Mean | None:
    ages = group["age"].cast(pl.Float64).to_numpy()
    return mean(ages, "years") if group["age"].count() else None


def _regions(groups: Mapping[str, pl.DataFrame]) -> tuple[Answer, ...]:
    counted = _counted(
        {name: list(map(world_region, group["nationality"])) for name, group in groups.items()}
    )
    return tuple(sorted(counted, key=lambda row: _LAST.get(row.answer, 0)))


def _counted(given: Mapping[str, Sequence[str]]) -> tuple[Answer, ...]:
    """Count each answer in each group, the most frequent over all first, then by the alphabet."""
    table = [
        Answer(answer, {name: answers.count(answer) for name, answers in given.items()})
        for answer in sorted(set(given[OVERALL]))
    ]
    return tuple(sorted(table, key=lambda row: -row.counts[OVERALL]))
