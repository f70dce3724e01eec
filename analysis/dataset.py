"""Checked data, ready to be analysed."""

from __future__ import annotations

from dataclasses import dataclass, replace

import polars as pl

from .arms import Arms
from .contract import TRIALS
from .exclusions import Excluded
from .flow import Flow
from .mapping import TableMapping
from .plan import Plan
from .statistics.outcome import Clusters, Outcome
from .study import Source
from .validation import Oddity


@dataclass(frozen=True)
class Dataset:
    """Checked data of the plan's two conditions, without whom its exclusions took.

    `trials` has the columns of the contract that its file has, and always participant, condition,
    scenario, trial_index, stop_time_s, length_s, correct, prediction_time_s and confidence, the
    last five null where missing; and `treated`, whether the trial is of the treatment.
    `participants` is None without such a table. Both have whom the exclusions took, too, in
    `trials_before_exclusions` and `participants_before_exclusions`.

    `simulated` and `preview` count trials so marked: left out, or analysed if `with_simulated`.
    `other_conditions` counts the trials of conditions that the plan does not compare. `renamed`
    pairs the file's column names with those of the contract, by `mapping` or because they are
    understood without one. `exported` is whether Goalguess made the file of trials, whose times
    then count motion only. `recorded` names the columns that the file of participants has.
    `oddities` are of the whole files.
    """

    plan: Plan
    trials: pl.DataFrame
    participants: pl.DataFrame | None
    trials_before_exclusions: pl.DataFrame
    participants_before_exclusions: pl.DataFrame | None
    sources: tuple[Source, ...]
    simulated: int
    preview: int
    with_simulated: bool
    other_conditions: dict[str, int]
    excluded: tuple[Excluded, ...]
    flow: Flow
    renamed: tuple[tuple[str, str], ...]
    exported: bool
    recorded: tuple[str, ...]
    oddities: tuple[Oddity, ...]
    mapping: TableMapping

    @property
    def arms(self) -> Arms:
        """The two conditions that are compared."""
        return self.plan.arms

    @property
    def confidence_scale(self) -> tuple[float, float]:
        """The lowest and the highest rating."""
        return self.mapping.confidence

    @property
    def before_exclusions(self) -> Dataset:
        """The data with whom the exclusions took: everybody who was dealt one of the arms."""
        return replace(
            self,
            trials=self.trials_before_exclusions,
            participants=self.participants_before_exclusions,
        )


def outcome(data: Dataset, measure: str) -> Outcome:
    """Return a column of the trials, such as those of `Plan.primary`, as methods take it.

    True counts 1 and false 0; clusters are numbered in the order of their names.
    """
    trials = data.trials
    return Outcome(
        name=measure,
        unit=TRIALS.column(measure).unit or "share",
        y=trials[measure].cast(pl.Float64).to_numpy(),
        treated=trials["treated"].to_numpy(),
        participant=_numbered(trials["participant"]),
        scenario=_numbered(trials["scenario"]),
    )


def _numbered(names: pl.Series) -> Clusters:
    in_order = pl.Enum(names.unique().sort())
    return names.cast(in_order).to_physical().cast(pl.Int64).to_numpy()
