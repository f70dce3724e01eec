"""The block of statistics that the paper reports, from checked data."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from .arms import Arms
from .dataset import Dataset
from .demographics import Demographics, demographics
from .errors import EmptyArmError
from .sample import Sample, sample
from .statistics.estimates import Mean, Share, mean
from .statistics.normality import Normality, normality
from .statistics.ranks import MannWhitney, mann_whitney
from .statistics.two_by_two import ChiSquare, TwoByTwo, chi_square


@dataclass(frozen=True)
class Accuracy:
    """Correct guesses: the counts, the share per condition, the test."""

    table: TwoByTwo
    arms: dict[str, Share]
    test: ChiSquare


@dataclass(frozen=True)
class Ranked:
    """A measure compared by ranks: mean and normality per condition, the test."""

    arms: dict[str, Mean]
    normality: dict[str, Normality]
    test: MannWhitney


@dataclass(frozen=True)
class PaperBlock:
    """Everything of the paper's block; `demographics` is None without a participants table."""

    arms: Arms
    sample: Sample
    correct: Accuracy
    prediction_time: Ranked
    confidence: Ranked
    demographics: Demographics | None


def as_in_paper(data: Dataset) -> PaperBlock:
    """Compute the paper's statistics; EmptyArmError if a condition has no value of a measure."""
    return PaperBlock(
        arms=data.arms,
        sample=sample(data),
        correct=_accuracy(data),
        prediction_time=_ranked(data, "prediction_time_s", "s"),
        confidence=_ranked(data, "confidence", "scale points"),
        demographics=demographics(data),
    )


def values_of(data: Dataset, arm: str, measure: str) -> NDArray[np.float64]:
    """Return one condition's values of a measure, trial by trial, NaN where missing."""
    column = data.trials.filter(pl.col("condition") == arm)[measure]
    return column.cast(pl.Float64).to_numpy()


def _values_of_arms(data: Dataset, measure: str) -> dict[str, NDArray[np.float64]]:
    values = {arm: values_of(data, arm, measure) for arm in data.arms.names}
    for arm, each in values.items():
        if np.isnan(each).all():
            name = "guess" if measure == "correct" else measure
            raise EmptyArmError(arm, name, file=data.sources[0].file)
    return values


def _accuracy(data: Dataset) -> Accuracy:
    count = _values_of_arms(data, "correct")
    treatment, reference = count.values()
    table = TwoByTwo(
        treatment_correct=int((treatment == 1).sum()),
        treatment_wrong=int((treatment == 0).sum()),
        reference_correct=int((reference == 1).sum()),
        reference_wrong=int((reference == 0).sum()),
        n_missing_treatment=int(np.isnan(treatment).sum()),
        n_missing_reference=int(np.isnan(reference).sum()),
    )
    return Accuracy(table, dict(zip(count, table.arms, strict=True)), chi_square(table))


def _ranked(data: Dataset, measure: str, unit: str) -> Ranked:
    values = _values_of_arms(data, measure)
    treatment, reference = values.values()
    return Ranked(
        arms={arm: mean(each, unit) for arm, each in values.items()},
        normality={arm: normality(each) for arm, each in values.items()},
        test=mann_whitney(treatment, reference, measure),
    )
