"""The whole report in its order: the answer, what to mind, figures, tables, the fine print."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ..results import Results
from ..statistics.codes import NO_SCENARIO_SHARED
from ..wording import capital
from .adjusted_tables import adjusted_parts
from .answers import answers
from .apa import apa_sentences
from .design_tables import chance_parts, discrimination_parts, likeness_parts, stops_parts
from .document import Heading, Items, Paragraph, Part, Picture
from .fine_print import fine_print_parts
from .method_tables import method_parts
from .paper import TITLE as AS_IN_PAPER
from .paper import demographics_parts, paper_parts
from .people_tables import sample_parts, sensitivity_parts
from .selection_tables import device_parts, exclusion_parts

_TITLE = "what the study shows"
_HOW = (
    "These tests take both participants and scenarios as drawn from many, so they speak of other "
    "people and other scenarios too."
)
_ELSEWHERE = (
    "Tests that take every trial as independent, as the paper does, stand below under "
    f"{AS_IN_PAPER}."
)


def report_parts(
    results: Results, pictures: Mapping[str, Sequence[Picture]] | None = None
) -> list[Part]:
    """Return the whole report with the figures that were drawn, by their section."""
    data, evidence, plan = results.data, results.evidence, results.data.plan
    return [
        *_answer(results),
        *_figures(pictures or {}),
        Heading("Who took part"),
        *sample_parts(evidence.paper.sample, data.flow, data.arms),
        *demographics_parts(evidence.paper),
        *sensitivity_parts(evidence, plan),
        *exclusion_parts(evidence.exclusions, evidence.conclusions, plan),
        *device_parts(evidence.devices, evidence.conclusions, plan),
        Heading("All methods"),
        *(
            part
            for compared in evidence.comparisons.values()
            for part in method_parts(compared, plan.alpha)
        ),
        *stops_parts(evidence, plan),
        *adjusted_parts(evidence, plan),
        *chance_parts(evidence, plan),
        *discrimination_parts(evidence, plan),
        *paper_parts(evidence.paper, exported=data.exported),
        *likeness_parts(evidence),
        Heading("Sentences for a manuscript"),
        Items(apa_sentences(results)),
        *fine_print_parts(data, evidence, results.packages),
    ]


def brief_parts(results: Results) -> list[Part]:
    """Return what a terminal shows: the answer, what to mind, the paper's tests, the sample."""
    data, paper = results.data, results.evidence.paper
    return [
        *_answer(results),
        *paper_parts(paper, exported=data.exported),
        Heading("Who took part"),
        *sample_parts(paper.sample, data.flow, data.arms),
        *demographics_parts(paper),
    ]


def _answer(results: Results) -> list[Part]:
    arms, evidence = results.data.arms, results.evidence
    tested = any(each.direction != "undefined" for each in evidence.conclusions)
    shared = all(notice.code != NO_SCENARIO_SHARED for notice in results.notices)
    parts = [
        Heading(f"{capital(arms.treatment.label)} against {arms.reference.label}: {_TITLE}", 1),
        *answers(evidence.conclusions, evidence.comparisons, arms, results.data.plan.alpha),
        Paragraph(f"{_HOW} {_ELSEWHERE}" if tested and shared else _ELSEWHERE),
    ]
    if results.notices:
        noted = tuple(notice.text for notice in results.notices)
        parts += [Heading("Please note"), Items(noted)]
    return parts


def _figures(pictures: Mapping[str, Sequence[Picture]]) -> list[Part]:
    parts: list[Part] = [Heading("Figures")] if pictures else []
    for section, drawn in pictures.items():
        parts += [Heading(section, 3), *drawn]
    return parts
