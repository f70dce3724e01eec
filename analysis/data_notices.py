"""What a reader must be told of the data themselves, whatever is computed from them."""

from __future__ import annotations

from dataclasses import dataclass

import polars as pl

from .dataset import Dataset
from .statistics import codes
from .statistics.inference import FEW

WITH_THE_NUMBERS = ("synthetic_data", "simulated_included", "impossible_time")
"""Codes of notices that go wherever the numbers go: those are no result, or hold a program's."""

_SYNTHETIC_SHA256 = "4c6b0d3b083d3bf298a6a4e1cb210b924cae5c2963fcca90e9a3deeb4ea47e94"
"""Of the table of 1,500 trials that was made up because the authors' data are not published."""

_ODD = {
    "values_emptied": "Values that cannot be are read as empty; no test takes them.",
    "times_missing": "Times of a page are empty although a later one was finished, as where the "
    "server's clock was set back; no test takes them.",
}
"""What is said of each kind of oddity."""

_NAMED = 5
"""So many names are written out; the rest are counted."""


@dataclass(frozen=True)
class Notice:
    """A warning: a code for programs, what it is about, and a sentence for people."""

    code: str
    about: str
    text: str


def data_notices(data: Dataset) -> list[Notice]:
    """Tell which trials were left out, what was pooled, and where the design was not kept."""
    return [
        *_synthetic(data),
        *_selection(data),
        *_exclusions(data),
        *_impossible_times(data),
        *_oddities(data),
        *_several_studies(data),
        *_few_clusters(data),
        *_scenarios_not_shared(data),
        *_fewer_trials_than_planned(data),
    ]


def _synthetic(data: Dataset) -> list[Notice]:
    if all(source.sha256 != _SYNTHETIC_SHA256 for source in data.sources):
        return []
    text = "Not a result: synthetic data, made to print the paper's numbers."
    return [Notice("synthetic_data", "trials", text)]


def _selection(data: Dataset) -> list[Notice]:
    found = []
    if data.simulated or data.preview:
        marked = f"{data.simulated} simulated and {data.preview} preview trials"
        if data.with_simulated:
            text = f"Not a result: {marked} are in the numbers, as asked for."
            found.append(Notice("simulated_included", "trials", text))
        else:
            found.append(Notice("simulated_left_out", "trials", f"Left out: {marked}."))
    if data.other_conditions:
        counts = _listed([f"{n} of {name}" for name, n in data.other_conditions.items()])
        text = f"Left out, because the plan does not compare their conditions: trials, {counts}."
        found.append(Notice("other_conditions_left_out", "trials", text))
    return found


def _exclusions(data: Dataset) -> list[Notice]:
    found = []
    for each in data.excluded:
        n = len(each.participants)
        text = f"Participants excluded by the plan, who {each.exclusion.reason}: {n}."
        found.append(Notice("participants_excluded", each.exclusion.rule, text))
    return found


def _impossible_times(data: Dataset) -> list[Notice]:
    """Whoever answers by a program sends times that no clock but its own confirms."""
    people, trials = set(), 0
    for rows in (data.trials, data.participants):
        if rows is not None and "impossible_time" in rows.columns:
            flagged = rows.filter("impossible_time")
            people |= set(flagged["participant"])
            trials += len(flagged) if rows is data.trials else 0
    if not people:
        return []
    text = (
        f"Times that cannot be: {len(people)} of the participants analysed and {trials} of the "
        "trials have impossible_time, motion watched for longer than the server's clock allows or "
        "stopped before what had been seen, as by a program. All are in the numbers; the rule "
        "impossible_time of a plan leaves such participants out."
    )
    return [Notice("impossible_time", "participants", text)]


def _oddities(data: Dataset) -> list[Notice]:
    """What one odd row says is told instead of refusing the file."""
    found = []
    for code, said in _ODD.items():
        rows = [
            f"{odd.column} in {odd.rows} of {odd.file}" for odd in data.oddities if odd.code == code
        ]
        if rows:
            text = f"{said} Rows: {', '.join(rows)}."
            found.append(Notice(code, "trials and participants", text))
    return found


def _several_studies(data: Dataset) -> list[Notice]:
    """Trials recorded under different definitions of the study are not one sample."""
    if "study_hash" not in data.trials.columns:
        return []
    found = data.trials["study_hash"].drop_nulls().unique().sort().to_list()
    if len(found) < 2:
        return []
    text = f"Trials of {len(found)} definitions of the study are pooled: {', '.join(found)}."
    return [Notice("several_studies", "trials", text)]


def _few_clusters(data: Dataset) -> list[Notice]:
    sizes = {}
    for arm, label in data.arms.labels.items():
        own = data.trials.filter(pl.col("condition") == arm)
        sizes[f"participants with {label}"] = own["participant"].n_unique()
    sizes["scenarios"] = data.trials["scenario"].n_unique()
    few = [f"{what}: {size}" for what, size in sizes.items() if size < FEW]
    if not few:
        return []
    text = (
        f"Few clusters ({', '.join(few)}). With fewer than {FEW}, how much they differ is itself "
        "uncertain, and clustered intervals and p values are rough."
    )
    return [Notice(codes.FEW_CLUSTERS, "design", text)]


def _scenarios_not_shared(data: Dataset) -> list[Notice]:
    alone = (
        data.trials.group_by("scenario")
        .agg(pl.col("treated").n_unique().alias("arms"))
        .filter(pl.col("arms") == 1)["scenario"]
        .sort()
        .to_list()
    )
    if not alone:
        return []
    scenarios = data.trials["scenario"].n_unique()
    if len(alone) == scenarios:
        text = (
            f"No scenario was seen in both conditions: how the {scenarios} scenarios differ cannot "
            "be told from what the conditions do."
        )
        return [Notice(codes.NO_SCENARIO_SHARED, "design", text)]
    text = (
        f"Scenarios seen in one condition only, where they cannot be told from it: {len(alone)} "
        f"of {scenarios} ({_listed(alone)})."
    )
    return [Notice(codes.SCENARIOS_NOT_SHARED, "design", text)]


def _fewer_trials_than_planned(data: Dataset) -> list[Notice]:
    planned = data.plan.trials_per_participant
    trials = data.trials.group_by("participant").len("trials")["trials"].to_numpy()
    n, most = int((trials < planned).sum()), trials.max()
    if not n:
        return []
    text = (
        f"Participants with fewer than the plan's {planned} trials: {n} of {len(trials)}; the "
        "trials they answered are analysed."
    )
    if most < planned:
        text = f"Nobody has the plan's {planned} trials; the most that anyone has are {most}."
    return [Notice("fewer_trials_than_planned", "participants", text)]


def _listed(names: list[str]) -> str:
    more = len(names) - _NAMED
    return ", ".join([*names[:_NAMED], *([f"and {more} more"] if more > 0 else [])])
