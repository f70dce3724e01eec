"""The plan's primary tests on some of the participants, as exclusions and devices choose them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import polars as pl

from .dataset import Dataset, outcome
from .errors import EmptyArmError
from .methods import primary_test
from .plan import Primary
from .statistics.outcome import Outcome
from .statistics.result import TestResult

MOST_TRIALS = 100_000
"""Above, the tests of some twenty selections would take longer than all the rest of a report."""


@dataclass(frozen=True)
class Selection:
    """Some participants, counted by condition, their trials, and the primary tests on these.

    `tests` is by measure, None where an arm has no value of it.
    """

    participants: Mapping[str, int]
    trials: int
    tests: Mapping[str, TestResult | None]


class Selector:
    """Runs the primary tests on any of those who have trials, excluded or not.

    Of the same participants they run once: most rules and devices take all or nobody.
    """

    def __init__(self, data: Dataset, as_analysed: Mapping[str, TestResult]) -> None:
        self._data = data.before_exclusions
        self.everybody = frozenset(self._data.trials["participant"].unique())
        self.analysed = frozenset(data.trials["participant"].unique())
        self._done = {self.analysed: _selection(data, as_analysed)}

    def only(self, participants: Iterable[str]) -> Selection:
        """Return the tests on these participants; those without trials do not count."""
        chosen = self.everybody.intersection(participants)
        if chosen not in self._done:
            kept = self._data.trials.filter(pl.col("participant").is_in(chosen))
            data = replace(self._data, trials=kept)
            tests = {
                each.measure: tested(each, outcome(data, each.measure))
                for each in data.plan.primary
            }
            self._done[chosen] = _selection(data, tests)
        return self._done[chosen]


def tested(primary: Primary, selected: Outcome) -> TestResult | None:
    """Run the plan's test of a hypothesis; None if an arm has no value."""
    try:
        return primary_test(primary, selected)
    except EmptyArmError:
        return None


def _selection(data: Dataset, tests: Mapping[str, TestResult | None]) -> Selection:
    people = data.trials.select("participant", "condition").unique()["condition"]
    return Selection(
        {name: int((people == name).sum()) for name in data.arms.names}, len(data.trials), tests
    )
