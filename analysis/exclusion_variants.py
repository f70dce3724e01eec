"""The primary results with and without each exclusion rule, whether the plan uses it or not."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import polars as pl

from .dataset import Dataset
from .exclusions import RULES, Exclusion, cannot_be_applied, taken
from .selections import Selection, Selector

Change = Literal["as_planned", "without_rule", "with_rule", "no_rule"]


@dataclass(frozen=True)
class ExclusionVariant:
    """The primary tests under exclusions that differ from the plan's in one respect.

    `exclusion` is the rule that is left out or applied in addition, None for the other changes;
    `left_out` counts the participants with trials whom the rules took. Where `cannot` says why the
    rule cannot be applied, `left_out` and `selection` are None.
    """

    change: Change
    exclusion: Exclusion | None
    left_out: int | None
    selection: Selection | None
    cannot: str = ""


def exclusion_variants(data: Dataset, selector: Selector) -> tuple[ExclusionVariant, ...]:
    """Repeat the primary tests without each rule of the plan, with each other one, with none.

    The same numbers as by a plan with these rules: a rule takes whom it takes, whatever other
    rules do. Rules of which the plan says nothing take the parameters in `RULES`.
    """
    return tuple(_variants(data, selector))


def _variants(data: Dataset, selector: Selector) -> Iterator[ExclusionVariant]:
    planned = data.plan.exclusions
    takes = [_taken(each, data) for each in planned]

    def without(change: Change, exclusion: Exclusion | None, *sets: set[str]) -> ExclusionVariant:
        out = selector.everybody.intersection(set().union(*sets))
        selection = selector.only(selector.everybody - out)
        return ExclusionVariant(change, exclusion, len(out), selection)

    yield without("as_planned", None, *takes)
    for place, exclusion in enumerate(planned):
        yield without("without_rule", exclusion, *takes[:place], *takes[place + 1 :])
    for exclusion in _further(data):
        if cannot := cannot_be_applied(exclusion, data.trials_before_exclusions, _people(data)):
            yield ExclusionVariant("with_rule", exclusion, None, None, cannot)
        else:
            yield without("with_rule", exclusion, *takes, _taken(exclusion, data))
    if planned:
        yield without("no_rule", None)


def _further(data: Dataset) -> Iterator[Exclusion]:
    """Return the rules that the plan does not use, with their usual parameters.

    Lists of trials are as long as planned or, where nobody has so many, as the longest.
    """
    trials = data.trials_before_exclusions
    most = int(trials.group_by("participant").len()["len"].max())  # type: ignore[arg-type]
    used = {each.rule for each in data.plan.exclusions}
    for name, rule in RULES.items():
        if name not in used:
            yield Exclusion(name, rule.usual(min(data.plan.trials_per_participant, most)))


def _taken(exclusion: Exclusion, data: Dataset) -> set[str]:
    return set(taken(exclusion, data.trials_before_exclusions, _people(data))["participant"])


def _people(data: Dataset) -> pl.DataFrame | None:
    """Return the participants with the columns that their file has."""
    people = data.participants_before_exclusions
    return None if people is None else people.select(data.recorded)
