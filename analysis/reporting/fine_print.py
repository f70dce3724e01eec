"""The fine print: definitions, methods and sources, the plan, what the report is made from."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from ..dataset import Dataset
from ..evidence import Evidence
from ..mapping import TableMapping
from ..plan import Plan
from ..statistics.equivalence import Equivalence
from ..statistics.result import TestResult
from ..statistics.superiority import Superiority
from ..statistics.survival import Incidence
from .document import Heading, Items, Paragraph, Part
from .method_tables import PRIMARY, method_names

_MOTION_ONLY = "both count motion only"
_AS_GIVEN = "both are as the table gives them; whether a lead-in is counted in is not known"
_DEFINITIONS = (
    "Time of prediction is the stop time if the guess was correct, else the full length; {times}.",
    "Estimates are signed: positive means more with {treatment}. An AUC is the probability that a "
    "trial with {treatment} has the larger value than one with {reference}, ties counted half; .5 "
    "is no difference.",
    "Clustered by participant and scenario: influence values are summed over participants, over "
    "scenarios and over trials; the variance is the first two less the third, and not less than "
    "the first. Student's t is on the smaller of two degrees of freedom: the number of scenarios "
    "less one, and those of the participants, which are Welch's, as the arms share in the variance "
    "by participant, and with one arm, or with participants in both, their number less one. Mixed "
    "models take those of the two-way test.",
    "Where the two-way test and the mixed model fall on different sides of alpha, the conclusion "
    "is drawn from the two-way test.",
    "What is excluded where no difference is shown is told by two one-sided tests on estimate, "
    "standard error and degrees of freedom of the primary test, against the plan's smallest effect "
    "of interest. Both must reject at alpha, so of one measure a false exclusion has at most that "
    "chance. Holm's correction, which guards against a difference shown where there is none, is "
    "not theirs: that any of several measures has a false one may be more probable.",
    "Intervals are at 95 %, where nothing else is said. Those of single arms in the paper's block "
    "are Wilson's for shares and Student's t for means. Tests of normality describe the data and "
    "decide nothing.",
    "In the paper's block, chi-square is Pearson's without continuity correction; Mann-Whitney is "
    "two-sided and asymptotic, with tie correction and without continuity correction. The U "
    "printed first is the smaller of the two, as in the paper; the treatment's own U counts the "
    "pairs in which its value is larger, ties half.",
)


def fine_print_parts(data: Dataset, evidence: Evidence, packages: Mapping[str, str]) -> list[Part]:
    """Return what is needed to check the report, or to make it again."""
    words = {
        "treatment": data.arms.treatment.label,
        "reference": data.arms.reference.label,
        "times": _MOTION_ONLY if data.exported else _AS_GIVEN,
    }
    files = (f"{each.file}: {each.rows:,} rows, SHA-256 {each.sha256}" for each in data.sources)
    software = ", ".join(f"{name} {version}" for name, version in packages.items())
    return [
        Heading("Fine print"),
        Items(tuple(each.format(**words) for each in _DEFINITIONS)),
        Heading("Methods and their sources", 3),
        Items(_sources(evidence)),
        *_plan(data.plan),
        Heading("Made from", 3),
        Items((*files, *_reading(data), software)),
    ]


def _reading(data: Dataset) -> Iterator[str]:
    """Say what the file's names, conditions, units and ratings were taken for."""
    mapping = data.mapping
    if mapping == TableMapping():
        yield "No mapping"
    else:
        yield f"{mapping.file}, SHA-256 of what it says: {mapping.sha256}"
    if data.renamed:
        yield f"Columns: {_pairs(data.renamed, 'as')}"
    if mapping.conditions:
        yield f"Conditions: {_pairs(mapping.conditions.items(), 'as')}"
    if mapping.units:
        yield f"Units: {_pairs(mapping.units.items(), 'in')}, all turned into s"
    low, high = data.confidence_scale
    yield f"Confidence: from {low:g} to {high:g}"


def _pairs(pairs: Iterable[tuple[str, str]], between: str) -> str:
    return ", ".join(f"{one} {between} {other}" for one, other in pairs)


def _sources(evidence: Evidence) -> tuple[str, ...]:
    """Say of every method that was run, once, how it was done and where that is from."""
    run: list[tuple[str, TestResult | Incidence | Equivalence | Superiority]] = [
        (method_names(compared)[key].removesuffix(PRIMARY), result)
        for compared in evidence.comparisons.values()
        for key, result in compared.results.items()
    ]
    run += [
        ("Rate of correct stops", evidence.two_way_cox),
        ("Rate of correct stops", evidence.cox),
        *_adjusted(evidence),
        ("Cumulative incidence", evidence.incidence),
        ("Against chance", evidence.chance[0]),
        ("Confidence, right against wrong", evidence.discrimination[0]),
        ("Likeness of trials", next(iter(evidence.likeness.values())).correlation),
        ("Who left", evidence.sensitivity.dropout),
    ]
    run += [
        ("What is excluded", each.equivalence) for each in evidence.conclusions if each.equivalence
    ]
    run += [
        ("Probability of a larger share", compared.superiority)
        for compared in evidence.comparisons.values()
        if compared.superiority
    ]
    told = (f"{name}: {result.method}. Source: {result.source}." for name, result in run)
    return tuple(dict.fromkeys(told))


def _adjusted(evidence: Evidence) -> Iterator[tuple[str, TestResult]]:
    if evidence.adjustment is not None:
        for model in evidence.adjustment.models.values():
            yield "Adjusted for covariates", model.effect


def _plan(plan: Plan) -> list[Part]:
    return [
        Heading("Plan", 3),
        Paragraph(f"{plan.file}, SHA-256 of what it says: {plan.sha256}"),
        Items(tuple(f"{key}: {_written(value)}" for key, value in plan.content.items())),
    ]


def _written(value: object) -> str:
    """Write a value of the plan much as its file does."""
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {_written(each)}" for key, each in value.items())
    if isinstance(value, list):
        return "; ".join(map(_written, value)) or "none"
    return str(value)
