"""The tables of the framework comparison, from its rows: means, failures, paired differences."""

from dataclasses import asdict, dataclass
from itertools import combinations
from pathlib import Path

import polars as pl

from policies.experiments.balance import balanced
from policies.experiments.comparison import FRAMEWORKS, POLMDPS
from policies.experiments.paired import PairedTest, holm, mean_interval, paired_test

SELECTIONS = ("balanced", "all")
MEASURES = ("polmdp", "polmdp_per_step", "lmdp", "time_s", "planning_s")
"""Columns of the rows that have means; `time_s` is the planning with the goal MDPs' solves."""

_WORLD = ("world", "states", "goals")


@dataclass(frozen=True)
class Tables:
    """What a run shows, a row a world in their order, smallest first.

    means: n, mean and 95 % interval of each selection, measure and framework. failures: of all
    runs, how many timed out, and how many of the others did not arrive. differences: of each
    selection and measure, framework minus `against` over the pairs that both finished, Holm's
    correction over the worlds. ratios: mean time of L-MDP over that of each PoLMDP, with and
    without the goals' solves, over all runs: one that timed out counts with the time it had.
    """

    means: pl.DataFrame
    failures: pl.DataFrame
    differences: pl.DataFrame
    ratios: pl.DataFrame


def read_rows(file: Path) -> pl.DataFrame:
    """The rows of a run in the order of worlds, pairs and frameworks, whoever finished first."""
    rows = pl.read_csv(file, schema_overrides={"world": pl.String, "goal": pl.String})
    return rows.with_columns(
        pl.col("arrived", "timed_out").cast(pl.Boolean),
        time_s=pl.col("goal_solves_s") + pl.col("planning_s"),
        failed=pl.col("arrived") == 0,
    ).sort("states", "goals", "world", "pair", "framework")


def make_tables(rows: pl.DataFrame, seed: int) -> Tables:
    """All tables of a run's rows; `seed` chooses where balancing leaves out at random."""
    selected = {"balanced": balanced(rows, seed), "all": rows}
    finished = {name: kept.filter(~pl.col("failed")) for name, kept in selected.items()}
    return Tables(
        means=pl.concat([_means(finished[name], name, rows) for name in SELECTIONS]),
        failures=_failures(rows),
        differences=pl.concat([_differences(finished[name], name, rows) for name in SELECTIONS]),
        ratios=_ratios(rows),
    )


def worlds_of(rows: pl.DataFrame) -> pl.DataFrame:
    """The worlds in order: name, number of states, number of goals."""
    return rows.select(_WORLD).unique(maintain_order=True)


def frameworks_of(rows: pl.DataFrame) -> list[str]:
    """The frameworks of rows or of a table, in the order of FRAMEWORKS."""
    there = set(rows["framework"])
    return [framework for framework in FRAMEWORKS if framework in there]


def contrasts_of(rows: pl.DataFrame) -> list[tuple[str, str]]:
    """Every two frameworks of rows or of a table, the earlier one first."""
    return list(combinations(frameworks_of(rows), 2))


def _means(finished: pl.DataFrame, selection: str, rows: pl.DataFrame) -> pl.DataFrame:
    table = []
    for world in worlds_of(rows).iter_rows(named=True):
        for framework in frameworks_of(rows):
            of_it = finished.filter(world=world["world"], framework=framework)
            for measure in MEASURES:
                mean = asdict(mean_interval(of_it[measure].to_numpy()))
                chosen = {"selection": selection, "measure": measure, "framework": framework}
                table.append({**world, **chosen, **mean})
    return pl.DataFrame(table)


def _failures(rows: pl.DataFrame) -> pl.DataFrame:
    return rows.group_by(*_WORLD, "framework", maintain_order=True).agg(
        runs=pl.len(),
        timed_out=pl.col("timed_out").sum(),
        not_arrived=(~pl.col("arrived") & ~pl.col("timed_out")).sum(),
        failed_percent=100 * (~pl.col("arrived")).mean(),
    )


def _ratios(rows: pl.DataFrame) -> pl.DataFrame:
    times = rows.group_by(*_WORLD, "framework", maintain_order=True).agg(
        pl.col("time_s", "planning_s").mean()
    )
    lmdp = times.filter(framework="lmdp").drop("framework")
    polmdps = times.filter(pl.col("framework").is_in(list(POLMDPS.values())))
    return polmdps.join(lmdp, on=_WORLD, suffix="_lmdp", maintain_order="left").select(
        *_WORLD,
        "framework",
        time_ratio=pl.col("time_s_lmdp") / pl.col("time_s"),
        planning_ratio=pl.col("planning_s_lmdp") / pl.col("planning_s"),
    )


def _differences(finished: pl.DataFrame, selection: str, rows: pl.DataFrame) -> pl.DataFrame:
    table = []
    for measure in MEASURES:
        by_pair = finished.pivot(
            "framework", frameworks_of(rows), index=["world", "pair"], values=measure
        )
        for framework, against in contrasts_of(rows):
            both = by_pair.drop_nulls([framework, against])
            tests = []
            for world in worlds_of(rows).iter_rows(named=True):
                of_it = both.filter(world=world["world"])
                test = paired_test(of_it[framework].to_numpy(), of_it[against].to_numpy())
                chosen = {"selection": selection, "measure": measure}
                tests.append({**world, **chosen, **_contrast(framework, against, test)})
            table.append(
                pl.DataFrame(tests).with_columns(
                    p_t_holm=pl.Series(holm([test["p_t"] for test in tests])),
                    p_wilcoxon_holm=pl.Series(holm([test["p_wilcoxon"] for test in tests])),
                )
            )
    return pl.concat(table)


def _contrast(framework: str, against: str, test: PairedTest) -> dict[str, object]:
    numbers = asdict(test)
    return {"framework": framework, "against": against, **numbers.pop("difference"), **numbers}
