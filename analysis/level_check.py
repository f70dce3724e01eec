"""How often do the tests find a difference where there is none? Their type I error, simulated.

Both arms guess, rate and stop alike in the simulated studies; what differs are participants,
scenarios, and what a scenario happens to be like in one arm (its interaction with the condition).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .crossed_model import Design, Spread, confidence_model, correct_model
from .simulated_stops import StopsModel
from .simulated_studies import ALPHA, Model, Rejections, Tell, by_measure, rejections

SHARE_CORRECT = 0.775
"""Of both arms: half way between the paper's 85 % and 70 %."""


@dataclass(frozen=True)
class LevelTable:
    """Rejections of each test, a column for each of `spreads`, where the arms do not differ."""

    spreads: tuple[Spread, ...]
    studies: int
    rows: Mapping[str, tuple[Rejections, ...]]

    @property
    def monte_carlo_error(self) -> float:
        """Distance from `ALPHA` within which an exact test stays in 95 % of simulations."""
        return float(1.96 * (ALPHA * (1 - ALPHA) / self.studies) ** 0.5)


def level_check(
    spreads: Sequence[Spread],
    tests: Sequence[str],
    design: Design,
    studies: int,
    seed: int,
    workers: int,
    tell: Tell,
) -> LevelTable:
    """Run tests on simulated studies without a difference, `studies` for each of `spreads`.

    Each test is of one of the measures of `TESTS`; tests of one measure are run on the same trials.
    """
    columns: dict[str, list[Rejections]] = {test: [] for test in tests}
    for spread in spreads:
        for measure, own in by_measure(tests).items():
            model = _without_difference(measure, spread)
            for each in rejections(model, design, own, studies, seed, workers, tell):
                columns[each.test].append(each)
    rows = {test: tuple(column) for test, column in columns.items()}
    return LevelTable(tuple(spreads), studies, rows)


def _without_difference(measure: str, spread: Spread) -> Model:
    if measure == "correct":
        return correct_model(spread, SHARE_CORRECT, SHARE_CORRECT)
    if measure == "confidence":
        return confidence_model(spread, auc=0.5)
    return StopsModel(spread)
