"""What a reader of the numbers must be told: warnings of the tests, and of the data."""

from __future__ import annotations

from .as_in_paper import PaperBlock
from .data_notices import Notice, data_notices
from .dataset import Dataset
from .evidence import Evidence
from .statistics.dropout import Dropout
from .warning_texts import WARNINGS
from .wording import format_p

_FEW_EXPECTED = 5


def notices(data: Dataset, evidence: Evidence) -> list[Notice]:
    """Collect what limits the numbers, the gravest first."""
    return [
        *data_notices(data),
        *_about_dropout(data, evidence.sensitivity.dropout),
        *_about_tests(evidence.paper),
        *_about_gaps(data, evidence.paper),
    ]


def _about_dropout(data: Dataset, dropout: Dropout) -> list[Notice]:
    """Tell that the arms lost different shares: who stayed is no longer dealt at random."""
    alpha = data.plan.alpha
    if dropout.fisher_p >= alpha:
        return []
    treatment, reference = data.arms.labels.values()
    text = (
        f"Differential dropout: {dropout.left_treatment} of {dropout.participants_treatment} left "
        f"with {treatment}, {dropout.left_reference} of {dropout.participants_reference} with "
        f"{reference} (Fisher's exact {format_p(dropout.fisher_p, alpha=alpha)}). Those who "
        "stayed may differ between the arms for other reasons than the condition."
    )
    return [Notice("differential_dropout", "participants", text)]


def _about_tests(block: PaperBlock) -> list[Notice]:
    found = [_of_test(code, "correct guesses") for code in block.correct.test.warnings]
    if not found and block.correct.test.min_expected < _FEW_EXPECTED:
        smallest = block.correct.test.min_expected
        text = (
            f"Correct guesses: the smallest expected count is {smallest:.1f}, below "
            f"{_FEW_EXPECTED}; the p of chi-square is rough."
        )
        found.append(Notice("small_expected_count", "correct guesses", text))
    for name, ranked in (
        ("time of prediction", block.prediction_time),
        ("confidence", block.confidence),
    ):
        found += [_of_test(code, name) for code in ranked.test.warnings]
        for arm, label in block.arms.labels.items():
            about = f"normality of {name}, {label}"
            found += [_of_test(code, about) for code in ranked.normality[arm].warnings]
    return found


def _of_test(code: str, about: str) -> Notice:
    return Notice(code, about, f"{about[0].upper()}{about[1:]}: {WARNINGS[code]}.")


def _about_gaps(data: Dataset, block: PaperBlock) -> list[Notice]:
    found = []
    for name, missing in (
        ("correct guesses", block.correct.test.n_missing),
        ("time of prediction", block.prediction_time.test.n_missing),
        ("confidence", block.confidence.test.n_missing),
    ):
        if missing:
            text = f"{name.capitalize()}: {missing} missing, left out of its numbers."
            found.append(Notice("missing_values", name, text))
    incomplete = sum(arm.incomplete for arm in block.sample.arms.values())
    if incomplete and not _incomplete_by_the_plan(data, block):
        text = (
            f"Incomplete participants: {incomplete} ({block.sample.incomplete_means}); "
            "the trials they answered are analysed."
        )
        found.append(Notice("incomplete_participants", "participants", text))
    if data.participants is None:
        text = "No participants table came with these trials, so there are no demographics."
        found.append(Notice("no_participants_table", "participants", text))
    if data.renamed:
        pairs = ", ".join(f"{name} as {meant}" for name, meant in data.renamed)
        found.append(
            Notice("columns_renamed", "trials", f"Columns read under other names: {pairs}.")
        )
    return found


def _incomplete_by_the_plan(data: Dataset, block: PaperBlock) -> bool:
    """Tell whether incomplete are those with fewer trials than planned, noted with the data."""
    most = max(arm.most_trials for arm in block.sample.arms.values())
    return data.participants is None and most >= data.plan.trials_per_participant
