"""Which figures a report has, in which order, under which captions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

from .. import figures
from ..as_in_paper import values_of
from ..dataset import Dataset
from ..evidence import Evidence
from ..methods import Comparison
from ..statistics.mixed_model import CrossedLogistic
from ..statistics.result import TestResult
from ..statistics.survival import Incidence
from ..wording import capital, percent
from .answers import WORDS
from .method_tables import PRIMARY, in_shares, method_names

TIME, CONFIDENCE = "prediction_time", "confidence"


@dataclass(frozen=True)
class Drawing:
    """A figure to be drawn: its section, the stem of its files, its caption."""

    section: str
    name: str
    caption: str
    draw: Callable[[], figures.Drawn]


def drawings(data: Dataset, evidence: Evidence) -> Iterator[Drawing]:
    """List the figures of a report, section by section."""
    labels = data.arms.treatment.label, data.arms.reference.label
    paper, trials, chance = evidence.paper, data.trials, data.plan.chance_level
    confidence = figures.confidence_scale(*data.confidence_scale)
    scales = {
        "correct": figures.CORRECT,
        "prediction_time_s": figures.PREDICTION_TIME,
        "stop_time_s": figures.STOP_TIME,
        "confidence": confidence,
    }
    as_in_paper = {
        "correct": lambda: figures.figure_correct(list(paper.correct.arms.values()), labels),
        TIME: lambda: figures.figure_prediction_time(
            list(paper.prediction_time.arms.values()), labels
        ),
        CONFIDENCE: lambda: figures.figure_confidence(
            [values_of(data, arm, "confidence") for arm in data.arms.names], labels, confidence
        ),
    }
    captions = {
        "correct": "Share of correct guesses, as in the paper: trials taken as independent.",
        TIME: "Mean time of prediction, as in the paper: trials taken as independent.",
        CONFIDENCE: "Confidence, as in the paper: trials taken as independent.",
    }
    for compared, name in zip(evidence.comparisons.values(), as_in_paper, strict=True):
        words, scale = WORDS[compared.measure].name, scales[compared.measure]
        section = capital(words)
        yield Drawing(section, name, captions[name], as_in_paper[name])
        yield Drawing(
            section,
            f"raincloud_{name}",
            f"Participants: means of {words}.",
            partial(figures.figure_raincloud, trials, scale, labels),
        )
        yield Drawing(
            section,
            f"slopes_{name}",
            f"Scenarios: {words} in both arms.",
            partial(figures.figure_slopes, trials, scale, labels),
        )
        yield Drawing(
            section,
            f"forest_{name}",
            f"Methods that estimate the same effect on {words}.",
            partial(_forest, compared, labels, data.plan.alpha),
        )
    section = "Stops, ratings and right guesses"
    yield Drawing(
        section,
        "incidence",
        _incidence_caption(evidence.incidence, labels),
        lambda: figures.figure_incidence(
            evidence.incidence, labels, "Motion seen" if data.exported else "Time"
        ),
    )
    yield Drawing(
        section,
        "accuracy_by_time",
        "Correct guesses by the time of the stop.",
        lambda: figures.figure_accuracy_by_time(evidence.by_time, labels, chance),
    )
    yield Drawing(
        section,
        "calibration",
        "Correct guesses by confidence.",
        lambda: figures.figure_calibration(evidence.by_confidence, labels, chance, confidence),
    )
    yield Drawing(
        section,
        "confidence_levels",
        "Ratings of confidence among right and wrong guesses.",
        lambda: figures.figure_confidence_levels(trials, labels, confidence),
    )
    yield Drawing(
        "Participants",
        "flow",
        "How far participants came (after CONSORT).",
        lambda: figures.figure_flow(data.flow, labels),
    )


def _incidence_caption(incidence: Incidence, labels: figures.Labels) -> str:
    """Set the shares counted of all trials beside the estimates of the curves."""
    counted = ", ".join(
        f"{percent(arm.n_correct / arm.n)} with {label}"
        for arm, label in zip((incidence.treatment, incidence.reference), labels, strict=True)
    )
    return (
        "Estimated share of trials that had come to a correct or a wrong stop by each time. "
        f"Counted, of all trials: {counted} ended in a correct stop."
    )


def _forest(compared: Comparison, labels: figures.Labels, alpha: float) -> figures.Drawn:
    """Draw the methods whose estimates stand on the primary test's scale."""
    names = {key: name.removesuffix(PRIMARY) for key, name in method_names(compared).items()}
    primary = compared.primary
    results = {names[key]: _on_scale(each, primary) for key, each in compared.results.items()}
    same = {
        name: each
        for name, each in results.items()
        if (each.unit, each.null, each.of) == (primary.unit, primary.null, primary.of)
    }
    effect = "AUC" if primary.unit == "probability" else "Difference"
    return figures.figure_forest(same, names[compared.primary_key], effect, labels, alpha)


def _on_scale(result: TestResult, primary: TestResult) -> TestResult:
    """Put the logistic model beside differences of shares by the difference that it implies."""
    if not isinstance(result, CrossedLogistic) or primary.unit != "share":
        return result
    return in_shares(result)
