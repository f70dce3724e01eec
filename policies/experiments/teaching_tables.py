"""The tables of the teaching experiment, from its rows: ratio correct, and who is ahead."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import polars as pl
from scipy import stats

from policies.experiments.paired import LEVEL, holm
from policies.experiments.teaching import EXAMPLES
from policies.pool import CONDITIONS


@dataclass(frozen=True)
class TeachingTables:
    """What a run shows after k = 1 to EXAMPLES examples.

    ratios: of each teacher and k, the ratio correct with its 95 % interval. differences: of each
    k, polmdp minus optimal with its 95 % interval, t, its p, and Holm's correction over k.
    chance: the ratio that guessing gives.
    """

    ratios: pl.DataFrame
    differences: pl.DataFrame
    chance: float


def make_teaching_tables(file: Path) -> TeachingTables:
    """All tables of the rows in `file`.

    Mazes are fixed and weigh the same; units (starts or sets) are drawn at random within them.
    All lessons of a unit, and both teachers in it, resemble each other: intervals and the paired
    t test take a unit's mean as one value.
    """
    rows = pl.read_csv(file, schema_overrides={"maze": pl.String})
    correct = _unit_means(rows)
    ratios = _over_units(correct, ["teacher", "k"]).rename({"mean": "ratio"})
    ahead = correct.pivot("teacher", index=["maze", "unit", "k"], values="value").with_columns(
        value=pl.col(CONDITIONS[0]) - pl.col(CONDITIONS[1])
    )
    tests = _over_units(ahead, ["k"]).rename({"mean": "difference"})
    # No difference in any unit is 0 / 0.
    t = (tests["difference"] / tests["se"]).fill_nan(0.0)
    p = 2 * np.asarray(stats.t.sf(np.abs(t.to_numpy()), tests["df"].to_numpy()))
    tests = tests.with_columns(t=t, p=pl.Series(p), p_holm=pl.Series(holm(p.tolist())))
    goals = rows.group_by("maze").agg(pl.col("goal").n_unique())["goal"]
    return TeachingTables(ratios, tests, chance=float(np.mean(1 / goals.to_numpy())))


def _unit_means(rows: pl.DataFrame) -> pl.DataFrame:
    """Ratio correct, `value`, of every maze, unit, teacher and k."""
    guess = pl.col("guesses").str.slice
    return (
        rows.group_by("maze", "unit", "teacher", maintain_order=True)
        .agg((guess(k, 1) == pl.col("goal")).mean().alias(str(k + 1)) for k in range(EXAMPLES))
        .unpivot(index=["maze", "unit", "teacher"], variable_name="k")
        .with_columns(pl.col("k").cast(pl.Int64))
    )


def _over_units(values: pl.DataFrame, by: list[str]) -> pl.DataFrame:
    """Mean of `value` over units, then over mazes; its standard error and t interval."""
    value = pl.col("value")
    mazes = values.group_by(*by, "maze").agg(value.mean(), n=pl.len(), variance=value.var())
    means = mazes.group_by(by).agg(
        mean=value.mean(),
        se=(pl.col("variance") / pl.col("n")).sum().sqrt() / pl.len(),
        df=(pl.col("n").cast(pl.Int64) - 1).sum(),
    )
    half = means["se"] * stats.t.ppf((1 + LEVEL) / 2, means["df"].to_numpy())
    return means.with_columns(low=means["mean"] - half, high=means["mean"] + half).sort(by)
