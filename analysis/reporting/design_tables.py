"""What stands beside the comparisons: likeness of trials, chance, stops, what confidence tells."""

from __future__ import annotations

from collections.abc import Iterable

from ..evidence import Evidence, Likeness
from ..plan import Plan
from ..statistics.result import TestResult
from ..warning_texts import WARNINGS
from ..wording import percent, without_zero
from .answers import WORDS
from .document import NOTHING, Grid, Heading, Items, Paragraph, Part, with_reason
from .effects import (
    beyond,
    bracketed,
    decimals_beside,
    interval,
    statement,
    statement_cell,
    value,
)
from .method_tables import HEADER, result_row

_UNDEFINED = "not defined with these data; a note below says why"


def likeness_parts(evidence: Evidence) -> list[Part]:
    """Return what the paper's tests take as independent, and how alike it is."""
    rows = tuple(
        _likeness_row(WORDS[measure].name, each) for measure, each in evidence.likeness.items()
    )
    header = (
        "",
        "correlation",
        "95 % interval",
        "design effect",
        "tips at effect",
        "tips at correlation",
    )
    return [
        Heading("How alike trials of a participant are", 3),
        Paragraph(
            "The paper's tests take this correlation as 0; for time and confidence it is that of "
            "the ranks, which these tests compare. The design effect is by how much it raises "
            "the variance of a difference between the arms. The last two columns say from where "
            "on the verdict of the paper's test tips: it would no longer be significant at .05. "
            "Scenarios, which are alike too, come on top of it."
        ),
        *with_reason(
            Grid("The paper's tests and clustering by participant", header, rows),
            "not defined where participants have one trial each, all values are equal, or no "
            "participant's trials differ",
        ),
    ]


def chance_parts(evidence: Evidence, plan: Plan) -> list[Part]:
    """Return each arm's share of correct guesses against guessing blindly."""
    # chance and all rows with as many decimals, so that they can be compared as printed
    more = max(map(decimals_beside, evidence.chance))
    rows = tuple(
        (
            label,
            NOTHING if test.estimate is None else percent(test.estimate, more),
            interval(test, more=more),
            statement_cell(test, plan.alpha),
        )
        for label, test in zip(plan.arms.labels.values(), evidence.chance, strict=True)
    )
    caption = f"Correct guesses against chance, {percent(plan.chance_level, more)}"
    header = ("", "correct", "95 % interval, %", "test")
    return [
        Heading("Against chance", 3),
        *with_reason(Grid(caption, header, rows), _UNDEFINED),
        *_notes(zip(plan.arms.labels.values(), evidence.chance, strict=True)),
    ]


def stops_parts(evidence: Evidence, plan: Plan) -> list[Part]:
    """Return how trials ended, and the rate of correct stops."""
    incidence, cox = evidence.incidence, evidence.two_way_cox
    rows = tuple(
        (label, f"{arm.n:,}", f"{arm.n_correct:,}", f"{arm.n_wrong:,}", f"{arm.n_censored:,}")
        for label, arm in zip(
            plan.arms.labels.values(), (incidence.treatment, incidence.reference), strict=True
        )
    )
    by_clustering = [
        ("Cox regression, clustered by participant and scenario", cox),
        ("Cox regression, clustered by participant", evidence.cox),
    ]
    return [
        Heading("Time to a correct stop", 3),
        Paragraph(
            "A stop with a wrong guess competes with a correct one, and who watches to the end is "
            f"censored there. Rate of correct stops, {plan.arms.treatment.label} against "
            f"{plan.arms.reference.label}: {bracketed(cox)}, {statement(cox, plan.alpha)} "
            "(Cox regression, clustered by participant and scenario)."
        ),
        Grid(
            "How trials ended",
            ("", "trials", "correct stops", "wrong stops", "watched to the end"),
            rows,
        ),
        *with_reason(
            Grid(
                "Rate of correct stops, one estimate with its uncertainty by either clustering",
                HEADER,
                tuple(result_row(name, test, plan.alpha) for name, test in by_clustering),
            ),
            _UNDEFINED,
        ),
        *_notes(by_clustering),
    ]


def discrimination_parts(evidence: Evidence, plan: Plan) -> list[Part]:
    """Return whether confidence tells right guesses from wrong ones, in each arm."""
    rows = tuple(
        (
            label,
            value(test),
            interval(test),
            statement_cell(test, plan.alpha),
            NOTHING if test.gamma is None else without_zero(test.gamma, 3),
        )
        for label, test in zip(plan.arms.labels.values(), evidence.discrimination, strict=True)
    )
    return [
        Heading("Whether confidence tells right from wrong", 3),
        *with_reason(
            Grid(
                "Confidence of right against wrong guesses; an AUC of .5 tells nothing",
                ("", "AUC", "95 % interval", "test", "gamma"),
                rows,
            ),
            _UNDEFINED,
        ),
        *_notes(zip(plan.arms.labels.values(), evidence.discrimination, strict=True)),
    ]


def _likeness_row(name: str, likeness: Likeness) -> tuple[str, ...]:
    correlation, tipping = likeness.correlation, likeness.tipping
    effect = NOTHING if likeness.design_effect is None else f"{likeness.design_effect:.2f}"
    return (
        name,
        value(correlation),
        interval(correlation),
        effect,
        NOTHING if tipping is None else _tipping_effect(tipping.design_effect_max),
        NOTHING if tipping is None else _tipping_correlation(tipping.icc_max),
    )


def _tipping_effect(largest: float) -> str:
    return "not significant" if largest < 1 else f"{largest:.2f}"


def _tipping_correlation(largest: float | None) -> str:
    if largest is None:
        return NOTHING
    if largest < 0:
        return "not significant"
    return "stays significant at any" if largest > 1 else without_zero(largest, 3)


def _notes(named: Iterable[tuple[str, TestResult]]) -> list[Part]:
    notes = []
    for name, test in named:
        notes += [f"{name}: {WARNINGS[code]}." for code in test.warnings]
        if outside := beyond(test):
            notes.append(f"{name}: {outside}.")
    return [Items(tuple(notes))] if notes else []
