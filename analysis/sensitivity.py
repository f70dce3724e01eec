"""Whether the answers hang on who left: dropout by arm, completers, intention to treat."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import polars as pl

from .completion import Completion, completion
from .contract import COMPLETED
from .dataset import Dataset, outcome
from .methods import primary_test
from .selections import tested
from .statistics.dropout import (
    Dropout,
    completers,
    differential_dropout,
    intention_to_treat,
)
from .statistics.result import TestResult


@dataclass(frozen=True)
class Sensitivity:
    """The primary tests on other selections of trials, by measure.

    `counted` says whom `dropout` counts. `intention_to_treat` is None where nobody has as many
    trials as the plan deals, so that the length of the lists is not known; a test of `completers`
    is None where an arm has none. `filled_in` says what stands for a trial never answered.
    """

    dropout: Dropout
    counted: str
    completers: Mapping[str, TestResult | None]
    intention_to_treat: Mapping[str, TestResult] | None
    filled_in: Mapping[str, float]


def sensitivity(data: Dataset) -> Sensitivity:
    """Repeat the primary tests with completers only, and with everybody's whole list.

    Completers are of those analysed; who left and everybody's lists are counted before exclusions,
    which may take the very participants who left.
    """
    everybody = data.before_exclusions
    dropout, counted = _dropout(everybody)
    filled_in = {each.measure: _worst(everybody, each.measure) for each in data.plan.primary}
    return Sensitivity(
        dropout=dropout,
        counted=counted,
        completers=_of_completers(data),
        intention_to_treat=_of_whole_lists(everybody, filled_in),
        filled_in=filled_in,
    )


def _dropout(data: Dataset) -> tuple[Dropout, str]:
    """Compare the arms' shares of those who left, of all whom the tables know."""
    if data.participants is None:
        found = _completion(data)
        people, who, left = found.people, "participants with a trial", found.incomplete
    else:
        people = data.participants.filter(pl.col("condition").is_in(data.arms.names))
        people = people.with_columns(done=pl.col("status") == COMPLETED)
        who, left = "participants dealt a condition", "study not completed"
    if data.plan.exclusions:
        who += ", excluded or not"
    treated = (people["condition"] == data.arms.treatment.condition).to_numpy()
    return differential_dropout(treated, people["done"].to_numpy()), f"{who}; left: {left}"


def _of_completers(data: Dataset) -> dict[str, TestResult | None]:
    done = _completion(data).people.sort("participant")["done"].to_numpy()
    return {
        each.measure: tested(each, completers(outcome(data, each.measure), done))
        for each in data.plan.primary
    }


def _of_whole_lists(data: Dataset, filled_in: Mapping[str, float]) -> dict[str, TestResult] | None:
    planned = data.plan.trials_per_participant
    if _completion(data).people.select(pl.col("trials").max()).item() < planned:
        return None
    return {
        each.measure: primary_test(
            each,
            intention_to_treat(outcome(data, each.measure), planned, filled_in[each.measure]),
        )
        for each in data.plan.primary
    }


def _completion(data: Dataset) -> Completion:
    return completion(data.trials, data.participants, data.plan.trials_per_participant)


def _worst(data: Dataset, measure: str) -> float:
    """Return the worst of a measure: a wrong guess, the mean full length, the lowest rating."""
    if measure == "correct":
        return 0.0
    if measure == "confidence":
        return data.confidence_scale[0]
    return float(data.trials["length_s"].drop_nulls().to_numpy().mean())
