"""Every figure can be read: at a column's width, with long labels, many trials, or next to none."""

from collections.abc import Callable
from functools import cache
from itertools import combinations

import numpy as np
import polars as pl
import pytest

from analysis.figures import (
    CONFIDENCE,
    CORRECT,
    PREDICTION_TIME,
    Drawn,
    Labels,
    figure_accuracy_by_time,
    figure_calibration,
    figure_confidence,
    figure_confidence_levels,
    figure_correct,
    figure_flow,
    figure_forest,
    figure_incidence,
    figure_prediction_time,
    figure_raincloud,
    figure_slopes,
)
from analysis.flow import Flow, Group, Step
from analysis.statistics.calibration import accuracy_by_confidence, accuracy_by_time
from analysis.statistics.estimates import mean, share
from analysis.statistics.outcome import Outcome
from analysis.statistics.result import TestResult
from analysis.statistics.survival import cumulative_incidence, stops
from tests.analysis.figures.studies import LABELS, LONG_LABELS, all_alike, texts, trials

COLUMN_INCHES = 85 / 25.4
SMALLEST_POINTS = 6

STUDIES = {
    "300 participants, 100 scenarios, long labels": (trials(300, 10, 100), LONG_LABELS),
    "one participant an arm, long labels": (trials(2), LONG_LABELS),
    "all values equal": (all_alike(12), LABELS),
}


def numbers(study: pl.DataFrame, column: str):
    return study[column].cast(pl.Float64).to_numpy()


def arms(study: pl.DataFrame, column: str):
    treated = study["treated"].to_numpy()
    values = numbers(study, column)
    return values[treated], values[~treated]


def outcome(study: pl.DataFrame):
    clusters = (study[name].to_numpy() for name in ("participant", "scenario"))
    correct = numbers(study, "correct")
    return Outcome("correct", "share", correct, study["treated"].to_numpy(), *clusters)


def incidence(study: pl.DataFrame):
    return cumulative_incidence(
        stops(
            numbers(study, "stop_time_s"),
            numbers(study, "length_s"),
            numbers(study, "correct"),
            study["treated"].to_numpy(),
            study["participant"].to_numpy(),
            study["scenario"].to_numpy(),
        )
    )


def result(estimate: float | None) -> TestResult:
    return TestResult(
        estimate=estimate,
        low=None if estimate is None else estimate - 0.06,
        high=None if estimate is None else estimate + 0.06,
        null=0.5,
        unit="probability",
        symbol="t",
        statistic=None,
        df=None,
        p=None if estimate is None else 0.0423,
        n=1500,
        n_missing=0,
        method="a method",
        source="a source",
    )


FOREST = {
    "Clustered by participant and scenario, both ways": result(0.41),
    "Mann-Whitney on trials, as in the paper": result(0.43),
    "A mixed model that did not converge, of a very long and even longer name": result(None),
}


def flow(study: pl.DataFrame) -> Flow:
    each = study["participant"].n_unique() // 2
    per_arm = {"polmdp": each, "optimal": each}
    return Flow(
        (
            Step(Group("gave consent", 2 * each + 7, None), (Group("screened out", 7, None),)),
            Step(
                Group("answered a trial", 2 * each, per_arm),
                (
                    Group(
                        "stopped before the robot had made any choice in at least 3 trials",
                        0,
                        {"polmdp": 0, "optimal": 0},
                    ),
                ),
                (Group("completed the study", 2 * each, per_arm),),
            ),
            Step(Group("analysed", 2 * each, per_arm)),
        )
    )


FIGURES: dict[str, Callable[[pl.DataFrame, Labels], Drawn]] = {
    "correct": lambda study, labels: figure_correct(
        [share(int(each.sum()), len(each)) for each in arms(study, "correct")], labels
    ),
    "prediction time": lambda study, labels: figure_prediction_time(
        [mean(each, "s") for each in arms(study, "prediction_time_s")], labels
    ),
    "confidence": lambda study, labels: figure_confidence(arms(study, "confidence"), labels),
    "raincloud of correct": lambda study, labels: figure_raincloud(study, CORRECT, labels),
    "raincloud of time": lambda study, labels: figure_raincloud(study, PREDICTION_TIME, labels),
    "raincloud of confidence": lambda study, labels: figure_raincloud(study, CONFIDENCE, labels),
    "slopes of correct": lambda study, labels: figure_slopes(study, CORRECT, labels),
    "slopes of time": lambda study, labels: figure_slopes(study, PREDICTION_TIME, labels),
    "confidence levels": figure_confidence_levels,
    "incidence": lambda study, labels: figure_incidence(incidence(study), labels),
    "forest": lambda _, labels: figure_forest(
        FOREST, next(iter(FOREST)), "Time, AUC", labels, 0.05
    ),
    "flow": lambda study, labels: figure_flow(flow(study), labels),
    "calibration": lambda study, labels: figure_calibration(
        accuracy_by_confidence(outcome(study), numbers(study, "confidence"), range(1, 8)),
        labels,
        1 / 6,
    ),
    "accuracy by time": lambda study, labels: figure_accuracy_by_time(
        accuracy_by_time(outcome(study), numbers(study, "stop_time_s")), labels, 1 / 6
    ),
}


@cache
def draw(name: str, study: str) -> Drawn:
    return FIGURES[name](*STUDIES[study])


@pytest.mark.parametrize("study", STUDIES)
@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_can_be_read_in_a_narrow_column_and_nothing_overlaps_or_is_cut(name, study):
    figure = draw(name, study).figure
    written = list(texts(figure))
    shrunk = COLUMN_INCHES / figure.get_figwidth()
    assert min(float(text.get_fontsize()) for text in written) * shrunk >= SMALLEST_POINTS
    places = [(text.get_text(), text.get_window_extent().padded(-1)) for text in written]
    for text, place in places:
        assert figure.bbox.padded(1).containsx(place.x0), text
        assert figure.bbox.padded(1).containsx(place.x1), text
        assert figure.bbox.padded(1).containsy(place.y0), text
        assert figure.bbox.padded(1).containsy(place.y1), text
    for (text, place), (other, elsewhere) in combinations(places, 2):
        assert not place.overlaps(elsewhere), f"{text!r} over {other!r}"


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_comes_with_words_and_numbers(name):
    drawn = draw(name, "all values equal")
    assert drawn.alt.endswith(".")
    assert any(character.isdigit() for character in drawn.alt)
    if name != "forest":
        assert all(label in drawn.alt for label in LABELS)
    assert "nan" not in drawn.alt.lower()
    assert len(drawn.data) > 0
    for column in drawn.data.select(pl.selectors.float()):
        assert np.isfinite(column.drop_nulls().to_numpy()).all()
