"""The block As in the paper: its tests on trials, its table of demographics."""

from __future__ import annotations

import re

from .. import wording
from ..arms import Arms
from ..as_in_paper import PaperBlock, Ranked
from ..demographics import OVERALL
from ..statistics.estimates import Mean
from .document import NOTHING, Grid, Heading, Items, Paragraph, Part, with_reason

TITLE = "As in the paper"

_INDEPENDENT = (
    "These are the paper's tests. They treat trials as independent. That is the paper's choice, "
    "kept so that numbers can be compared with it. Trials of one participant, and trials of one "
    "scenario, resemble each other, so these p values and intervals overstate certainty."
)
_LEAD_IN = "The original videos contain about 5 s of lead-in before the robot moves."
_MOTION_ONLY = (
    "Goalguess counts motion only, so the paper's mean times of 15.67 s and 18.22 s cannot be "
    "compared with times that Goalguess recorded."
)
_AS_GIVEN = (
    "Times are as the table gives them; whether a lead-in is counted in is not known, so they "
    "may not be comparable with the paper's mean times of 15.67 s and 18.22 s."
)

_REGIONS = (
    "World regions are those of UN M49, with Northern America apart from Latin America and the "
    "Caribbean, and follow from the nationalities below them by a list that comes with Goalguess "
    "(analysis/nationalities.csv). Several: nationalities of more than one region. Not recognised: "
    "an answer with a word that the list does not have; nothing is guessed. Not told: no answer, "
    "or “prefer not to say”."
)


def paper_parts(block: PaperBlock, *, exported: bool) -> list[Part]:
    """Return the paper's statistics: in words, then a table a measure.

    `exported` is whether Goalguess made the table of trials, and so counted the times itself.
    """
    return [
        Heading(TITLE),
        Paragraph(_INDEPENDENT),
        Items(paper_sentences(block)),
        Paragraph(f"{_LEAD_IN} {_MOTION_ONLY if exported else _AS_GIVEN}"),
        *_correct(block),
        *_ranked(block.prediction_time, block.arms, "Time of prediction"),
        *_ranked(block.confidence, block.arms, "Confidence"),
    ]


def paper_sentences(block: PaperBlock) -> tuple[str, ...]:
    """Say what the paper's tests show of each measure, in a line each."""
    treatment, reference = block.correct.arms.values()
    arms, test = block.arms, block.correct.test
    more = _verdict(arms, test.p, treatment.share - reference.share, "more", "fewer")
    chi2 = wording.chi_square_statistic(test)
    return (
        f"Correct guesses: {wording.percent(treatment.share)} with {arms.treatment.label}, "
        f"{wording.percent(reference.share)} with {arms.reference.label}; {more}, "
        f"{chi2}, {wording.format_p(test.p)}",
        _answer("Mean time of prediction", block.prediction_time, arms, " s", "longer", "shorter"),
        _answer("Mean confidence", block.confidence, arms, "", "higher", "lower"),
    )


def _answer(name: str, ranked: Ranked, arms: Arms, unit: str, larger: str, smaller: str) -> str:
    means = ", ".join(
        f"{ranked.arms[arm].mean:.2f}{unit} with {label}" for arm, label in arms.labels.items()
    )
    test = ranked.test
    verdict = _verdict(
        arms, test.p, test.rank_biserial, f"by ranks {larger}", f"by ranks {smaller}"
    )
    u = wording.format_u(test.u_smaller)
    return f"{name}: {means}; {verdict}, U = {u}, {wording.format_p(test.p)}"


def _verdict(arms: Arms, p: float | None, difference: float, larger: str, smaller: str) -> str:
    if p is None or p >= wording.ALPHA:
        return f"no difference shown at alpha = {wording.without_zero(wording.ALPHA, 2)}"
    return f"{larger if difference > 0 else smaller} with {arms.treatment.label}"


def _correct(block: PaperBlock) -> list[Part]:
    rows = tuple(
        (
            block.arms.labels[arm],
            str(share.count),
            str(share.n - share.count),
            str(share.n),
            wording.percent(share.share),
            f"{wording.percent(share.low)} to {wording.percent(share.high)}",
        )
        for arm, share in block.correct.arms.items()
    )
    header = ("", "correct", "wrong", "n", "correct, %", "95 % interval")
    return [
        Grid("Correct guesses, trials", header, rows),
        Items((wording.chi_square_apa(block.correct.test),)),
    ]


def _ranked(ranked: Ranked, arms: Arms, name: str) -> list[Part]:
    rows = tuple((arms.labels[arm], *_mean_cells(each)) for arm, each in ranked.arms.items())
    unit = next(iter(ranked.arms.values())).unit
    normality = (
        f"{arms.labels[arm]}, {wording.normality_apa(each)}"
        for arm, each in ranked.normality.items()
    )
    header = ("", "n", f"mean, {unit}", "95 % interval", "SD", "median")
    return [
        *with_reason(
            Grid(f"{name}, trials", header, rows),
            "one trial has no standard deviation, and its mean no interval",
        ),
        Items((wording.mann_whitney_apa(ranked.test), *normality)),
    ]


def _mean_cells(each: Mean) -> tuple[str, ...]:
    interval, sd = NOTHING, NOTHING
    if each.sd is not None:
        interval, sd = f"{each.low:.2f} to {each.high:.2f}", f"{each.sd:.2f}"
    return str(each.n), f"{each.mean:.2f}", interval, sd, f"{each.median:.2f}"


def demographics_parts(block: PaperBlock) -> list[Part]:
    """Return the paper's table of who took part."""
    found, groups = block.demographics, (*block.arms.names, OVERALL)
    if found is None:
        return [Paragraph("A single table of trials has no demographics; an export folder does.")]
    rows = [("participants", *(str(found.n[group]) for group in groups))]
    ages = [_age(found.age[group]) for group in groups]
    told = ("age, years: mean (SD)", "age, years: range", "age told by")
    rows += [(name, *cells) for name, cells in zip(told, zip(*ages, strict=True), strict=True)]
    for question, answers in ({"world_region": found.regions} | found.answers).items():
        name = question.replace("_", " ")
        for answer in answers:
            counts = (_counted(answer.counts[group], found.n[group]) for group in groups)
            rows.append((f"{name}: {_in_english(answer.answer)}", *counts))
    header = ("", *block.arms.labels.values(), "both")
    return [
        *with_reason(
            Grid("Demographics of participants with an analysed trial", header, tuple(rows)),
            "no age was told, or one alone, which has no standard deviation",
        ),
        Paragraph(_REGIONS),
    ]


def _in_english(answer: str) -> str:
    # exports hold answers in lower case throughout
    return re.sub(r"\bi\b", "I", answer)


def _age(age: Mean | None) -> tuple[str, str, str]:
    if age is None:
        return NOTHING, NOTHING, "0"
    sd = NOTHING if age.sd is None else f"{age.sd:.1f}"
    return f"{age.mean:.1f} ({sd})", f"{age.minimum:.0f} to {age.maximum:.0f}", str(age.n)


def _counted(count: int, n: int) -> str:
    return f"{count} ({wording.percent(count / n)})" if n else "0"
