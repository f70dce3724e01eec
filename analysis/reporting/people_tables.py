"""Who took part: sizes of the arms, how far participants came, who left and what that changes."""

from __future__ import annotations

from ..arms import Arms
from ..evidence import Evidence
from ..flow import Flow
from ..plan import Plan
from ..sample import Sample
from ..statistics.result import TestResult
from ..wording import format_p
from .answers import WORDS
from .document import Grid, Heading, Paragraph, Part, with_reason
from .effects import EFFECTS, effect_of, estimate_cell, interval, statement_cell, value


def sample_parts(sample: Sample, flow: Flow, arms: Arms) -> list[Part]:
    """Return who came how far, and how many participants and trials are analysed."""
    sizes = list(sample.arms.values())
    rows = [
        ("participants", *_with_sum([each.participants for each in sizes])),
        ("trials", *_with_sum([each.trials for each in sizes])),
        ("incomplete participants", *_with_sum([each.incomplete for each in sizes])),
    ]
    header = ("", *arms.labels.values(), "both")
    return [
        Grid("Analysed", header, tuple(rows)),
        Paragraph(
            f"Incomplete means: {sample.incomplete_means}. What these participants answered is "
            "analysed."
        ),
        Grid("How far participants came", header, tuple(_flow_rows(flow, arms))),
    ]


def sensitivity_parts(evidence: Evidence, plan: Plan) -> list[Part]:
    """Return who left each arm, and the primary tests without them and with their whole lists."""
    found = evidence.sensitivity
    selections = {
        "as analysed": {each.measure: each.primary for each in evidence.conclusions},
        "completers": found.completers,
        **({"intention to treat": found.intention_to_treat} if found.intention_to_treat else {}),
    }
    rows = tuple(
        _selection_row(
            f"{WORDS[each.measure].name}, {selection}", results[each.measure], plan.alpha
        )
        for each in evidence.conclusions
        for selection, results in selections.items()
    )
    return [
        Heading("Who left", 3),
        Paragraph(_who_left(evidence, plan)),
        *with_reason(
            Grid(
                "Primary tests on other selections",
                ("", "estimate", "95 % interval", "test", "trials"),
                rows,
            ),
            "not defined with these trials",
        ),
        Paragraph(_meaning(evidence, plan)),
    ]


def _who_left(evidence: Evidence, plan: Plan) -> str:
    left, arms = evidence.sensitivity.dropout, plan.arms
    return (
        f"Left: {left.left_treatment} of {left.participants_treatment} with "
        f"{arms.treatment.label}, {left.left_reference} of {left.participants_reference} with "
        f"{arms.reference.label} ({evidence.sensitivity.counted}). Difference {value(left)} "
        f"{effect_of(left).unit}, 95 % interval {interval(left)} by Newcombe's "
        "method. Fisher's exact test, which is another "
        f"than the interval's: {format_p(left.fisher_p, alpha=plan.alpha)}."
    )


def _meaning(evidence: Evidence, plan: Plan) -> str:
    if evidence.sensitivity.intention_to_treat is None:
        return (
            f"Intention to treat is left out: nobody has the plan's {plan.trials_per_participant} "
            "trials, so it is not known how many trials are missing."
        )
    worst = ", ".join(
        _worst(measure, value) for measure, value in evidence.sensitivity.filled_in.items()
    )
    began = "all who began" + (", excluded or not," if plan.exclusions else "")
    return (
        f"Intention to treat: {began} count with the plan's {plan.trials_per_participant} trials; "
        f"those not answered count as the worst case ({worst}). To begin is to answer a trial."
    )


def _worst(measure: str, value: float) -> str:
    """Say what stands for a trial never answered."""
    name = WORDS[measure].name
    if measure == "correct":
        return "a wrong guess"
    if measure == "confidence":
        return f"{name} {value:g}"
    return f"{name}: the mean full length, {EFFECTS['s'].with_unit(value)}"


def _selection_row(name: str, result: TestResult | None, alpha: float) -> tuple[str, ...]:
    if result is None:
        return (name, "an arm has none", "", "", "0")
    return (
        name,
        estimate_cell(result),
        interval(result),
        statement_cell(result, alpha),
        f"{result.n:,}",
    )


def _flow_rows(flow: Flow, arms: Arms) -> list[tuple[str, ...]]:
    rows = []
    for step in flow.steps:
        named = [
            (step.reached.what, step.reached),
            *((f"of these: {each.what}", each) for each in step.of_these),
            *((f"left: {each.what}", each) for each in step.left),
        ]
        for name, group in named:
            by_arm = ["", ""]
            if group.arms is not None:
                by_arm = [f"{group.arms[arm]:,}" for arm in arms.names]
            rows.append((name, *by_arm, f"{group.total:,}"))
    return rows


def _with_sum(values: list[int]) -> tuple[str, ...]:
    return tuple(f"{each:,}" for each in (*values, sum(values)))
