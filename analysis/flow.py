"""The flow of participants: who came how far, and why the others are not in the analysis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import polars as pl

from .arms import Arms
from .completion import completion
from .exclusions import Excluded
from .plan import Plan

_WITHDREW = (pl.col("status") == "withdrawn", "withdrew")


@dataclass(frozen=True)
class Group:
    """Participants of one kind: `total`, and by condition where conditions are known."""

    what: str
    total: int
    arms: Mapping[str, int] | None


@dataclass(frozen=True)
class Step:
    """Those who came this far.

    `left` says why some did not come to the next step, and `of_these` which part is worth telling.
    """

    reached: Group
    left: tuple[Group, ...] = ()
    of_these: tuple[Group, ...] = ()


@dataclass(frozen=True)
class Flow:
    """The steps in their order; the last one is the analysis.

    The total of each step less its `left` is the total of the next.
    """

    steps: tuple[Step, ...]


def participant_flow(
    plan: Plan,
    trials: pl.DataFrame,
    participants: pl.DataFrame | None,
    others: Mapping[str, int],
    excluded: Sequence[Excluded],
) -> Flow:
    """Follow the participants, from consent where their table is there, else from their trials.

    `trials` are those of both arms before exclusions; `others` counts the participants with
    trials of each further condition.
    """
    arms = plan.arms
    found = completion(trials, participants, plan.trials_per_participant)
    people, finished = found.people, found.finished
    if participants is None:
        before = _before_by_trials(people, others)
    else:
        before = _before_by_table(arms, people, participants)
    out = [name for each in excluded for name in each.participants]
    kept = people.filter(~pl.col("participant").is_in(out))
    answered = Step(
        _group("answered a trial", people, arms),
        left=tuple(_taken(each, people, arms) for each in excluded),
        of_these=(_group(finished, people.filter("done"), arms),),
    )
    analysed = Step(
        _group("analysed", kept, arms), of_these=(_group(finished, kept.filter("done"), arms),)
    )
    return Flow((*before, answered, analysed))


def _taken(excluded: Excluded, people: pl.DataFrame, arms: Arms) -> Group:
    own = people.filter(pl.col("participant").is_in(excluded.participants))
    return _group(excluded.exclusion.reason, own, arms)


def _before_by_trials(people: pl.DataFrame, others: Mapping[str, int]) -> list[Step]:
    if not others:
        return []
    left = tuple(Group(f"condition {name}", count, None) for name, count in others.items())
    return [Step(Group("in the table of trials", len(people) + sum(others.values()), None), left)]


def _before_by_table(arms: Arms, people: pl.DataFrame, participants: pl.DataFrame) -> list[Step]:
    has_trials = pl.col("participant").is_in(people["participant"].to_list())
    is_dealt = pl.col("condition").is_in(arms.names).fill_null(value=False)
    dealt = participants.filter(is_dealt)
    has_played = pl.col("first_played_at").is_not_null() | has_trials
    return [
        Step(
            _group("gave consent", participants),
            _reasons(
                participants.filter(~is_dealt),
                (pl.col("status") == "screened_out", "screened out"),
                (pl.col("status") == "failed", "failed the control question"),
                _WITHDREW,
                (pl.col("condition").is_not_null(), "dealt another condition"),
                (pl.col("dealt_at").is_not_null(), "gave the place back unplayed"),
                (pl.lit(value=True), "stopped before a place was dealt"),
            ),
        ),
        Step(
            _group("dealt a place", dealt, arms),
            _reasons(
                dealt.filter(~has_played),
                _WITHDREW,
                (pl.lit(value=True), "never began a trial"),
                arms=arms,
            ),
        ),
        Step(
            _group("played", dealt.filter(has_played), arms),
            _reasons(
                dealt.filter(has_played & ~has_trials),
                _WITHDREW,
                (pl.lit(value=True), "answered no trial"),
                arms=arms,
            ),
        ),
    ]


def _reasons(
    people: pl.DataFrame, *reasons: tuple[pl.Expr, str], arms: Arms | None = None
) -> tuple[Group, ...]:
    """Give everyone the first reason that holds; list the reasons that anyone was given."""
    found = []
    for holds, what in reasons:
        group, people = people.filter(holds), people.filter(~holds)
        if len(group):
            found.append(_group(what, group, arms))
    return tuple(found)


def _group(what: str, people: pl.DataFrame, arms: Arms | None = None) -> Group:
    if arms is None:
        return Group(what, len(people), None)
    counts = {name: int((people["condition"] == name).sum()) for name in arms.names}
    return Group(what, len(people), counts)
