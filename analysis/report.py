"""What the report says: the answer in words with numbers first, then tables, then fine print."""

from __future__ import annotations

from collections.abc import Mapping

from . import wording
from .arms import Arms
from .as_in_paper import PaperBlock, Ranked
from .data_notices import Notice
from .dataset import Dataset
from .demographics import OVERALL
from .document import Grid, Heading, Items, Paragraph, Part, Picture
from .statistics.estimates import Mean

FIGURES = {
    "correct": "Percentage of correct guesses per condition, with 95 % intervals",
    "prediction_time": "Mean time of prediction per condition in seconds, with 95 % intervals",
    "confidence": "Box plot of confidence per condition, with means and medians",
}
"""Stem of each figure's file, and its text for who does not see it."""

_FINE_PRINT = (
    "All tests here treat trials as independent. That is the paper's choice, kept so that "
    "numbers can be compared with it. Trials of one participant, and trials of one scenario, "
    "resemble each other, so these p values and intervals overstate certainty.",
    "The original videos contain about 5 s of lead-in before the robot moves. Goalguess counts "
    "motion only, so the paper's mean times of 15.67 s and 18.22 s cannot be compared with times "
    "that Goalguess recorded.",
    "Time of prediction is the stop time if the guess was correct, else the full length. "
    "Confidence runs from 1 to 7.",
    "Chi-square is Pearson's without continuity correction. Mann-Whitney is two-sided and "
    "asymptotic, with tie correction and without continuity correction; the U printed first is "
    "the smaller of the two, as in the paper, and the treatment's own U counts the pairs in "
    "which its value is larger, ties half.",
    "Intervals are at 95 %: Wilson's for shares, Student's t for means. Tests of normality "
    "describe the data and decide nothing.",
)


def report_parts(
    data: Dataset, block: PaperBlock, notices: list[Notice], packages: Mapping[str, str]
) -> list[Part]:
    """Return the whole report, for `document.markdown` or `document.plain_text`."""
    warned: list[Part] = [Heading("Please note"), Items(tuple(notice.text for notice in notices))]
    return [
        Heading("Legible and optimal robots: the statistics of the paper", 1),
        Items(_answers(block)),
        *(warned if notices else []),
        Heading("Who took part"),
        *_sample(block),
        Heading("Correct guesses"),
        *_correct(block),
        Heading("Time of prediction"),
        *_ranked(block.prediction_time, block.arms, "prediction_time"),
        Heading("Confidence"),
        *_ranked(block.confidence, block.arms, "confidence"),
        Heading("Demographics"),
        *_demographics(block),
        Heading("Fine print"),
        Items(_FINE_PRINT),
        Heading("Made from"),
        Grid(
            ("file", "rows", "SHA-256"),
            tuple((each.file, str(each.rows), each.sha256) for each in data.sources),
        ),
        Paragraph(", ".join(f"{name} {version}" for name, version in packages.items())),
    ]


def _answers(block: PaperBlock) -> tuple[str, ...]:
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


def _verdict(arms: Arms, p: float, difference: float, larger: str, smaller: str) -> str:
    if p >= wording.ALPHA:
        return f"no difference shown at alpha = {wording.without_zero(wording.ALPHA, 2)}"
    return f"{larger if difference > 0 else smaller} with {arms.treatment.label}"


def _sample(block: PaperBlock) -> list[Part]:
    arms = list(block.sample.arms.values())

    def row(name: str, values: list[int]) -> tuple[str, ...]:
        return (name, *map(str, values), str(sum(values)))

    rows = [
        row("participants", [arm.participants for arm in arms]),
        row("trials", [arm.trials for arm in arms]),
        row("incomplete participants", [arm.incomplete for arm in arms]),
    ]
    without = [arm.without_trials for arm in arms if arm.without_trials is not None]
    if without:
        rows.append(row("dealt a place, no trial answered", without))
    return [
        Grid(("", *block.arms.labels.values(), "both"), tuple(rows)),
        Paragraph(
            f"Incomplete means: {block.sample.incomplete_means}. What these participants answered "
            "is analysed."
        ),
    ]


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
    return [
        Grid(("", "correct", "wrong", "n", "correct, %", "95 % interval"), rows),
        Items((wording.chi_square_apa(block.correct.test),)),
        _picture("correct"),
    ]


def _ranked(ranked: Ranked, arms: Arms, figure: str) -> list[Part]:
    rows = tuple((arms.labels[arm], *_mean_cells(each)) for arm, each in ranked.arms.items())
    unit = next(iter(ranked.arms.values())).unit
    normality = (
        f"{arms.labels[arm]}, {wording.normality_apa(each)}"
        for arm, each in ranked.normality.items()
    )
    return [
        Grid(("", "n", f"mean, {unit}", "95 % interval", "SD", "median"), rows),
        Items((wording.mann_whitney_apa(ranked.test), *normality)),
        _picture(figure),
    ]


def _mean_cells(each: Mean) -> tuple[str, ...]:
    interval, sd = "NA", "NA"
    if each.sd is not None:
        interval, sd = f"{each.low:.2f} to {each.high:.2f}", f"{each.sd:.2f}"
    return str(each.n), f"{each.mean:.2f}", interval, sd, f"{each.median:.2f}"


def _demographics(block: PaperBlock) -> list[Part]:
    found, groups = block.demographics, (*block.arms.names, OVERALL)
    if found is None:
        return [Paragraph("A single table of trials has none; an export folder does.")]
    rows = [("participants", *(str(found.n[group]) for group in groups))]
    rows.append(("age, years: mean (SD), range, n", *(_age(found.age[group]) for group in groups)))
    for question, answers in found.answers.items():
        name = question.replace("_", " ")
        for answer in answers:
            counts = (_counted(answer.counts[group], found.n[group]) for group in groups)
            rows.append((f"{name}: {answer.answer}", *counts))
    return [
        Grid(("", *block.arms.labels.values(), "both"), tuple(rows)),
        Paragraph("Participants with at least one analysed trial; percentages are of them."),
    ]


def _age(age: Mean | None) -> str:
    if age is None:
        return "not told"
    sd = "NA" if age.sd is None else f"{age.sd:.1f}"
    return f"{age.mean:.1f} ({sd}), {age.minimum:.0f}-{age.maximum:.0f}, n = {age.n}"


def _counted(count: int, n: int) -> str:
    return f"{count} ({wording.percent(count / n)})" if n else "0"


def _picture(figure: str) -> Picture:
    return Picture(f"figures/{figure}.svg", FIGURES[figure])
