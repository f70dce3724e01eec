"""From files to the data that the plan analyses."""

from __future__ import annotations

from pathlib import Path

import polars as pl

from .dataset import Dataset
from .errors import EmptyArmError
from .exclusions import exclude
from .flow import participant_flow
from .mapping import TableMapping
from .plan import Plan, default_plan
from .study import read_study


def read_dataset(
    path: Path,
    plan: Plan | None = None,
    mapping: TableMapping | None = None,
    *,
    with_simulated: bool = False,
) -> Dataset:
    """Read an export folder or one file of trials (.csv, .parquet, .jsonl) and check it.

    Follows the default plan if given none. Rows of simulated and preview participants are left
    out unless `with_simulated`. TableError for the first broken rule, TomlError for a plan or a
    mapping that does not fit the data, EmptyArmError for a condition without trials.
    """
    plan, mapping = plan or default_plan(), mapping or TableMapping()
    study = read_study(path, mapping)
    chosen, participants = study.trials, study.participants
    if not with_simulated:
        chosen = _only_real(chosen)
        participants = None if participants is None else _only_real(participants)
    compared = pl.col("condition").is_in(plan.arms.names)
    trials, others = chosen.filter(compared), chosen.filter(~compared)
    file = study.sources[0].file
    _check_arms(plan, trials, file, _why_empty(plan, len(study.trials) - len(chosen), others))
    trials = trials.with_columns(treated=pl.col("condition") == plan.arms.treatment.condition)
    recorded = None if participants is None else participants.select(study.recorded)
    excluded = exclude(plan.exclusions, trials, recorded, plan.file)
    out = [name for each in excluded for name in each.participants]
    kept = ~pl.col("participant").is_in(out)
    analysed = trials.filter(kept)
    _check_arms(plan, analysed, file, f" ({len(out)} participants excluded by the plan)")
    others_by_condition = _by_condition(others, pl.col("participant").n_unique())
    return Dataset(
        plan=plan,
        trials=analysed,
        participants=None if participants is None else participants.filter(kept),
        trials_before_exclusions=trials,
        participants_before_exclusions=participants,
        sources=study.sources,
        simulated=_count(study.trials, "simulated"),
        preview=_count(study.trials, "preview"),
        with_simulated=with_simulated,
        other_conditions=_by_condition(others, pl.len()),
        excluded=excluded,
        flow=participant_flow(plan, trials, participants, others_by_condition, excluded),
        renamed=study.renamed,
        exported=study.exported,
        recorded=study.recorded,
        oddities=study.oddities,
        mapping=mapping,
    )


def _only_real(rows: pl.DataFrame) -> pl.DataFrame:
    marks = [pl.col(name) for name in ("simulated", "preview") if name in rows.columns]
    return rows.filter(~pl.any_horizontal(marks)) if marks else rows


def _count(rows: pl.DataFrame, mark: str) -> int:
    return int(rows[mark].sum()) if mark in rows.columns else 0


def _by_condition(trials: pl.DataFrame, count: pl.Expr) -> dict[str, int]:
    counts = trials.group_by("condition").agg(count.alias("count")).sort("condition")
    return dict(counts.iter_rows())


def _why_empty(plan: Plan, unreal: int, others: pl.DataFrame) -> str:
    """Say what may leave an arm empty: trials left out, conditions that the plan does not name."""
    found = ", ".join(others["condition"].unique().sort())
    note = f" ({unreal} simulated or preview trials left out)" if unreal else ""
    return f"{note}; {plan.file} compares none of: {found}" if found else note


def _check_arms(plan: Plan, trials: pl.DataFrame, file: str, note: str) -> None:
    for condition in plan.arms.names:
        if trials.filter(pl.col("condition") == condition).is_empty():
            raise EmptyArmError(condition, "trial", note, file)
