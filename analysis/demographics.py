"""The demographics table: who answered what, per condition and over all."""

from __future__ import annotations

from dataclasses import dataclass

import polars as pl

from .dataset import Dataset
from .statistics.estimates import Mean, mean

OVERALL = "overall"
"""The group of everybody, beside the conditions."""

QUESTIONS = ("gender", "nationality", "education", "occupation", "robot_familiarity")
"""Questions answered by a choice or a word; age, a number, is described apart."""

NO_ANSWER = "no answer"


@dataclass(frozen=True)
class Answer:
    """One answer to a question: `counts` per condition and `OVERALL`."""

    answer: str
    counts: dict[str, int]


@dataclass(frozen=True)
class Demographics:
    """Answers of the participants whose trials are analysed.

    `n` has the participants per condition and `OVERALL`; `age` their age in years, None for a
    group in which nobody told it; `answers` lists each question's answers, most frequent first.
    """

    n: dict[str, int]
    age: dict[str, Mean | None]
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
        answers={question: _answers(question, groups) for question in QUESTIONS},
    )


def _age(group: pl.DataFrame) -> Mean | None:
    ages = group["age"].cast(pl.Float64).to_numpy()
    return mean(ages, "years") if group["age"].count() else None


def _answers(question: str, groups: dict[str, pl.DataFrame]) -> tuple[Answer, ...]:
    given = {name: group[question].fill_null(NO_ANSWER).to_list() for name, group in groups.items()}
    different = sorted(set(given[OVERALL]))
    table = [
        Answer(answer, {name: given[name].count(answer) for name in groups}) for answer in different
    ]
    return tuple(sorted(table, key=lambda row: -row.counts[OVERALL]))
