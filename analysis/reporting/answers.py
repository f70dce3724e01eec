"""The answers to the hypotheses, in words with the numbers they rest on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..arms import Arms
from ..conclusions import EXPECTED, Conclusion, Direction
from ..methods import Comparison
from ..statistics.result import TestResult
from ..warning_texts import WARNINGS
from ..wording import capital, format_alpha, format_p, percent
from .document import Finding, Paragraph, Part
from .effects import beyond, decimals_beside, effect_of, estimate, interval, statement
from .excluded import excluded


@dataclass(frozen=True)
class _Words:
    """How a measure is spoken of: its name, and more or less of it."""

    name: str
    more: str
    less: str


WORDS = {
    "correct": _Words("correct guesses", "more", "fewer"),
    "prediction_time_s": _Words("time of prediction", "longer", "shorter"),
    "stop_time_s": _Words("stop time", "longer", "shorter"),
    "confidence": _Words("confidence", "higher", "lower"),
}
"""By the column of the trials."""


def answers(
    conclusions: Sequence[Conclusion],
    comparisons: Mapping[str, Comparison],
    arms: Arms,
    alpha: float,
) -> list[Part]:
    """Answer each primary test in the plan's order, then each hypothesis of several measures."""
    by_hypothesis: dict[str, list[Conclusion]] = {}
    for each in conclusions:
        by_hypothesis.setdefault(each.hypothesis, []).append(each)
    several = (own for own in by_hypothesis.values() if len(own) > 1)
    findings = (
        Finding(
            f"{each.hypothesis}, {WORDS[each.measure].name}: {_verdict(each, arms, alpha)}",
            f"{capital(means(comparisons[each.measure], arms))}. "
            + _numbers(each, comparisons[each.measure], arms, alpha),
        )
        for each in conclusions
    )
    return [*findings, *map(_together, several)]


def means(compared: Comparison, arms: Arms) -> str:
    """Say the share or the mean in each arm: 84.9 % correct with PoLMDP, 69.6 % with optimal."""
    if compared.measure == "correct":
        told = [percent(each.mean) for each in compared.means]
        told[0] += " correct"
    else:
        unit = " s" if compared.unit == "s" else ""
        told = [f"{each.mean:.2f}{unit}" for each in compared.means]
        told[0] = f"mean {told[0]}"
    labels = arms.labels.values()
    return ", ".join(f"{each} with {label}" for each, label in zip(told, labels, strict=True))


def _together(conclusions: Sequence[Conclusion]) -> Paragraph:
    """Answer a hypothesis that says something of several measures, all of which it needs."""
    expected = []
    for each in conclusions:
        words = WORDS[each.measure]
        expected.append(
            f"{words.more if EXPECTED[each.measure] == 'more' else words.less} {words.name}"
        )
    if all(each.supported for each in conclusions):
        verdict = "shown"
    elif any(each.supported for each in conclusions):
        verdict = "in part"
    elif all(each.direction == "undefined" for each in conclusions):
        verdict = "not to be tested with these data"
    else:
        verdict = "not shown"
    return Paragraph(f"{conclusions[0].hypothesis} ({' and '.join(expected)}): {verdict}.")


def _verdict(conclusion: Conclusion, arms: Arms, alpha: float) -> str:
    shown = _shown(conclusion.measure, conclusion.direction, arms)
    match conclusion.direction:
        case "undefined":
            return "not to be tested with these data."
        case "none":
            return f"{shown} at alpha = {format_alpha(alpha)}."
        case "more" | "less":
            return f"{shown}." if conclusion.supported else f"{shown}, against the hypothesis."


def _shown(measure: str, direction: Direction, arms: Arms) -> str:
    """Say what a test shows: longer with PoLMDP."""
    if direction not in ("more", "less"):
        return "no difference shown"
    words = WORDS[measure]
    return f"{words.more if direction == 'more' else words.less} with {arms.treatment.label}"


def _numbers(conclusion: Conclusion, compared: Comparison, arms: Arms, alpha: float) -> str:
    primary = conclusion.primary
    said = [_effect(conclusion, arms)]
    if conclusion.direction != "undefined":
        said.append(_tested(primary, conclusion.p_holm, alpha))
    notes = excluded(conclusion, compared, arms)
    notes += [f"{capital(WARNINGS[code])}." for code in primary.warnings]
    if outside := beyond(primary):
        notes.append(f"{capital(outside)}.")
    if beside := _beside(conclusion, arms, alpha):
        notes.append(beside)
    return " ".join((f"{'; '.join(said)}.", *notes))


def _tested(test: TestResult, p_holm: float | None, alpha: float) -> str:
    """Say statistic and p, and the corrected p of a test that stands in the family."""
    said = statement(test, alpha)
    return said if p_holm is None else f"{said}, Holm-corrected {format_p(p_holm, alpha=alpha)}"


def _effect(conclusion: Conclusion, arms: Arms) -> str:
    primary = conclusion.primary
    if primary.estimate is None:
        return "Effect not defined"
    bounds = "" if primary.low is None else f", 95 % interval {interval(primary)}"
    if primary.unit != "probability":
        difference = effect_of(primary).with_unit(primary.estimate, decimals_beside(primary))
        return f"Difference {difference}{bounds}"
    words, auc = WORDS[conclusion.measure], primary.estimate
    more_often, share = (words.more, auc) if auc >= primary.null else (words.less, 1 - auc)
    return (
        f"Of all pairs of trials, one from each arm, {percent(share)} have the {more_often} "
        f"{words.name} with {arms.treatment.label}, ties counted half ({estimate(primary)}"
        f"{bounds}; .5 is no difference)"
    )


def _beside(conclusion: Conclusion, arms: Arms, alpha: float) -> str:
    model = conclusion.model
    if model is None or conclusion.models_agree is None:
        return ""
    told = (
        f"{estimate(model)}, 95 % interval {interval(model)}, "
        f"{_tested(model, conclusion.model_p_holm, alpha)}"
    )
    if not conclusion.models_agree:
        shown = _shown(conclusion.measure, conclusion.model_direction, arms)
        return (
            f"The mixed model disagrees ({shown} at alpha = {format_alpha(alpha)}): {told}. "
            "The two-way test holds its level better, so the conclusion is drawn from it."
        )
    if conclusion.direction == "none":
        return f"The mixed model shows no difference either: {told}."
    return f"The mixed model agrees: {told}."
