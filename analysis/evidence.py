"""Everything the report rests on, computed from checked data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import polars as pl

from .adjustment import Adjustment, adjust
from .as_in_paper import PaperBlock, as_in_paper
from .conclusions import Conclusion, conclude
from .dataset import Dataset, outcome
from .devices import Devices, by_device
from .exclusion_variants import ExclusionVariant, exclusion_variants
from .methods import Comparison, compare
from .selections import MOST_TRIALS, Selector
from .sensitivity import Sensitivity, sensitivity
from .statistics.calibration import (
    AccuracyBy,
    Discrimination,
    accuracy_by_confidence,
    accuracy_by_time,
    discrimination,
)
from .statistics.chance import against_chance
from .statistics.cox import CoxResult, TwoWayCox, clustered_cox, two_way_cox
from .statistics.design_effect import TippingPoint, design_effect, tipping_icc
from .statistics.intraclass import (
    IntraclassCorrelation,
    intraclass_correlation,
    intraclass_correlation_of_ranks,
)
from .statistics.outcome import Numbers
from .statistics.survival import Incidence, cumulative_incidence, ending_known, stops
from .statistics.two_way import TwoWay


@dataclass(frozen=True)
class Likeness:
    """What the paper's test of a measure takes to be 0: how alike the trials of a participant are.

    `correlation` is of what the test compares: correct guesses, else ranks. `design_effect` is by
    what the variance between the arms is larger than with independent trials, None where
    undefined; `tipping` where the test's verdict falls, None without a statistic.
    """

    correlation: IntraclassCorrelation
    design_effect: float | None
    tipping: TippingPoint | None


@dataclass(frozen=True)
class Evidence:
    """The numbers of one analysis; mappings are by measure, a column of the trials.

    `chance` and `discrimination` are of the treatment and of the reference arm; `adjustment` is
    None where the plan names no covariates; `exclusions` and `devices` are None above
    `selections.MOST_TRIALS` trials.
    """

    paper: PaperBlock
    comparisons: Mapping[str, Comparison]
    conclusions: tuple[Conclusion, ...]
    likeness: Mapping[str, Likeness]
    chance: tuple[TwoWay, TwoWay]
    incidence: Incidence
    cox: CoxResult
    two_way_cox: TwoWayCox
    adjustment: Adjustment | None
    by_confidence: AccuracyBy
    by_time: AccuracyBy
    discrimination: tuple[Discrimination, Discrimination]
    sensitivity: Sensitivity
    exclusions: tuple[ExclusionVariant, ...] | None
    devices: Devices | None


def gather(data: Dataset) -> Evidence:
    """Compute it all; EmptyArmError if an arm has no value of a measure."""
    paper = as_in_paper(data)
    comparisons = {each.measure: compare(data, each) for each in data.plan.primary}
    correct = outcome(data, "correct")
    confidence = _numbers(data, "confidence")
    stop_time_s, length_s = _numbers(data, "stop_time_s"), _numbers(data, "length_s")
    ends = stops(
        stop_time_s,
        length_s,
        correct.y,
        correct.treated,
        correct.participant,
        correct.scenario,
    )
    selector = Selector(data, {measure: each.primary for measure, each in comparisons.items()})
    few = len(data.trials_before_exclusions) <= MOST_TRIALS
    low, high = data.confidence_scale
    levels = range(math.floor(low), math.ceil(high) + 1)
    return Evidence(
        paper=paper,
        comparisons=comparisons,
        conclusions=conclude(data.plan, comparisons),
        likeness=_likeness(data, paper),
        chance=against_chance(correct, data.plan.chance_level),
        incidence=cumulative_incidence(ends),
        cox=clustered_cox(ends),
        two_way_cox=two_way_cox(ends),
        adjustment=adjust(data, comparisons, ends, ending_known(stop_time_s, length_s, correct.y)),
        by_confidence=accuracy_by_confidence(correct, confidence, levels),
        by_time=accuracy_by_time(correct, stop_time_s),
        discrimination=discrimination(correct, confidence),
        sensitivity=sensitivity(data),
        exclusions=exclusion_variants(data, selector) if few else None,
        devices=by_device(data, selector) if few else None,
    )


def _likeness(data: Dataset, paper: PaperBlock) -> dict[str, Likeness]:
    """Set the paper's tests against how alike trials of a participant are."""
    of_correct = intraclass_correlation(outcome(data, "correct"))
    likeness = {"correct": _alike(of_correct, paper.correct.test.statistic)}
    for measure, test in (
        ("prediction_time_s", paper.prediction_time.test),
        ("confidence", paper.confidence.test),
    ):
        of_ranks = intraclass_correlation_of_ranks(outcome(data, measure))
        squared = None if test.statistic is None else test.statistic**2
        likeness[measure] = _alike(of_ranks, squared)
    return likeness


def _alike(correlation: IntraclassCorrelation, statistic: float | None) -> Likeness:
    size = correlation.trials_per_participant
    return Likeness(
        correlation,
        None if correlation.estimate is None else design_effect(correlation.estimate, size),
        None if statistic is None else tipping_icc(statistic, size),
    )


def _numbers(data: Dataset, measure: str) -> Numbers:
    """Return a column of the trials, NaN where missing."""
    return data.trials[measure].cast(pl.Float64).to_numpy().astype(np.float64)
