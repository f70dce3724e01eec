import numpy as np
import polars as pl
import pytest
from scipy import stats

from policies.experiments.paired import holm
from policies.experiments.tables import make_tables


def values(rows, world, framework, measure):
    of_it = rows.filter(
        pl.col("world") == world, pl.col("framework") == framework, ~pl.col("failed")
    )
    return of_it.sort("pair")[measure].to_numpy()


def one(table, **wanted):
    return table.filter(*(pl.col(key) == value for key, value in wanted.items())).row(0, named=True)


def test_means_are_of_the_runs_that_arrived(rows, tables):
    for world, n in (("2x2", 12), ("3x3", 10)):
        found = one(tables.means, world=world, framework="lmdp", measure="polmdp", selection="all")
        wanted = values(rows, world, "lmdp", "polmdp")
        low, high = stats.t.interval(0.95, n - 1, wanted.mean(), stats.sem(wanted))
        assert found["n"] == n
        assert [found[key] for key in ("mean", "low", "high")] == pytest.approx(
            [wanted.mean(), low, high]
        )


def test_every_world_framework_measure_and_selection_has_its_mean(tables):
    assert tables.means.height == 2 * 3 * 5 * 2
    assert tables.means["world"].unique(maintain_order=True).to_list() == ["2x2", "3x3"]


def test_balanced_means_keep_as_many_of_each_world_without_the_slowest(rows, tables):
    balanced = tables.means.filter(pl.col("selection") == "balanced")
    assert set(balanced["n"]) == {10}
    found = one(balanced, world="2x2", framework="optimal", measure="lmdp")
    # Two of the larger world failed; pairs 10 and 11 were the slowest of the other.
    assert found["mean"] == pytest.approx(values(rows, "2x2", "optimal", "lmdp")[:10].mean())


def test_failures_are_counted_apart(tables):
    lost = one(tables.failures, world="3x3", framework="lmdp")
    assert (lost["runs"], lost["timed_out"], lost["not_arrived"]) == (12, 1, 1)
    kept = tables.failures.filter(pl.col("framework") != "lmdp")
    assert kept["timed_out"].sum() + kept["not_arrived"].sum() == 0


def test_differences_are_paired_over_the_pairs_that_both_finished(rows, tables):
    found = one(
        tables.differences,
        **{"world": "3x3", "selection": "all", "measure": "polmdp"},
        **{"framework": "polmdp", "against": "lmdp"},
    )
    a, b = values(rows, "3x3", "polmdp", "polmdp")[2:], values(rows, "3x3", "lmdp", "polmdp")
    wanted = stats.ttest_rel(a, b)
    assert [found["n"], found["t"]] == pytest.approx([10, wanted.statistic])
    assert found["p_t"] == pytest.approx(wanted.pvalue)
    assert found["p_wilcoxon"] == pytest.approx(stats.wilcoxon(a, b, method="approx").pvalue)
    assert found["mean"] == pytest.approx(np.mean(a - b))


def test_holm_corrects_over_the_worlds_of_a_measure_and_a_contrast(tables):
    for p in ("p_t", "p_wilcoxon"):
        for _, family in tables.differences.group_by(
            "selection", "measure", "framework", "against", maintain_order=True
        ):
            assert family.height == 2
            assert family[f"{p}_holm"].to_list() == pytest.approx(holm(family[p].to_list()))


def test_a_known_difference_is_shown_and_noise_is_not(tables):
    of_all = tables.differences.filter(pl.col("selection") == "all", pl.col("against") == "lmdp")
    assert (of_all.filter(pl.col("measure") == "polmdp")["p_t_holm"] < 1e-6).all()
    assert (of_all.filter(pl.col("measure") == "lmdp")["p_t_holm"] > 0.05).all()


def test_ratios_are_of_mean_times_over_all_runs(tables):
    # L-MDP takes 10 to 21 s, PoLMDP 0.1 s.
    assert tables.ratios["time_ratio"].to_list() == pytest.approx([155, 155])
    assert tables.ratios["planning_ratio"].to_list() == pytest.approx([155, 155])


def test_a_framework_that_never_arrives_leaves_the_others_tables(rows):
    lost = rows.with_columns(failed=pl.col("failed") | (pl.col("framework") == "lmdp"))
    tables = make_tables(lost, seed=1)
    assert one(tables.means, framework="lmdp", selection="all")["n"] == 0
    assert set(tables.means.filter(pl.col("selection") == "balanced")["n"]) == {0}
    left = tables.differences.filter(pl.col("selection") == "all", pl.col("n") > 0)
    assert set(zip(left["framework"], left["against"], strict=True)) == {("polmdp", "optimal")}
