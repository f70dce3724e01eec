import re

import polars as pl
import pytest

from policies.experiments.comparison import Comparison, design_comparison
from policies.experiments.reading import write_means, write_reading
from policies.experiments.tables import make_tables
from tests.policies.experiments.numbers import numbers_of, printable, printed_in

HOW = Comparison("states", pairs=12, simulations=1000, seed=3)


@pytest.fixture(scope="module")
def reading(tables):
    return write_reading(HOW, tables)


def sentence(reading, measure, contrast):
    """What is said of two frameworks under a measure's heading."""
    of_measure = reading.split(f"**{measure}.**")[1].split("**")[0]
    return next(line for line in of_measure.splitlines() if line.startswith(f"- {contrast}"))


def test_it_says_what_was_run(reading):
    assert "12 pairs of start and goal a world" in reading
    assert "actions `udlr`, gamma 0.9, at most 4 x distance / .85 moves" in reading
    assert "PoLMDP with beta 0.5, formulation `reward`, r_leg `as_printed`" in reading
    assert "distance is `tv`, the beta of its observer 5." in reading
    assert "mode `miura` with 1,000 simulations a step and 60 s a pair" in reading


def test_who_leads_where_and_by_how_much(reading, tables):
    said = sentence(reading, "PoLMDP measure, discounted sum", "PoLMDP against L-MDP")
    for world in ("2x2", "3x3"):
        found = tables.differences.filter(
            pl.col("world") == world,
            pl.col("selection") == "all",
            pl.col("measure") == "polmdp",
            pl.col("framework") == "polmdp",
            pl.col("against") == "lmdp",
        ).row(0, named=True)
        assert f"{world} by {found['mean']:.3f} ({found['d_z']:.2f})" in said
    assert "PoLMDP leads in" in said
    assert "no difference shown" not in said


def test_where_nobody_leads_it_says_so(reading):
    said = sentence(reading, "L-MDP measure", "PoLMDP against L-MDP")
    assert said == "- PoLMDP against L-MDP: no difference shown in 2x2, 3x3."


def test_the_one_behind_is_told_as_the_other_ahead(rows):
    worse = rows.with_columns(
        pl.when(framework="polmdp").then(pl.col("polmdp") - 5).otherwise(pl.col("polmdp"))
    ).with_columns(lmdp=pl.col("polmdp"))
    reading = write_reading(HOW, make_tables(worse, seed=1))
    for measure in ("PoLMDP measure, discounted sum", "L-MDP measure"):
        said = sentence(reading, measure, "PoLMDP against L-MDP")
        leader = "L-MDP" if measure.startswith("PoLMDP") else "PoLMDP"
        assert re.search(rf"L-MDP: {leader} leads in 2x2 by [34]\.\d+ .*, 3x3 by", said)


def test_failures_are_told_by_kind(reading):
    assert "| 3x3 | 0 + 0 of 12 | 1 + 1 of 12 | 0 + 0 of 12 |" in reading
    assert "Of L-MDP's 2 failures 1 are of time and 1 of wandering" in reading


def test_without_failures_nothing_is_said_of_their_kind(rows):
    arrived = rows.with_columns(failed=False, arrived=True, timed_out=False)
    assert "L-MDP did not fail." in write_reading(HOW, make_tables(arrived, seed=1))


def test_times_are_told_as_ratios(reading):
    assert "| 2x2 | 155 | 155 |" in reading


def test_every_table_of_means_has_a_row_a_world(tables):
    text = write_means(HOW, tables)
    assert text.count("\n| 2x2 |") == text.count("\n| 3x3 |") == 8
    assert "![Figure: time](states-figure-time.svg)" in text


class TestNoNumberFromElsewhere:
    """Whatever is printed stands in the run's tables or in its design."""

    DEFINITIONS = ("2x2", "3x3", "differs from 0 at 0.05", "95 % intervals", "(paper, 4.2.2)")

    def lost(self, rows, framework):
        """These rows, with every second pair of a framework lost."""
        gone = (pl.col("framework") == framework) & (pl.col("pair") % 2 == 1)
        return rows.with_columns(arrived=pl.col("arrived") & ~gone, failed=pl.col("failed") | gone)

    @pytest.mark.parametrize(
        ("chosen", "defined"),
        [
            ({}, ["4 x distance / .85"]),
            ({"mode": "as_reported", "most_moves": 77}, []),
            ({"preset": "authors"}, ["sqrt(1 - b(g)^2)"]),
        ],
    )
    @pytest.mark.parametrize("framework", ["polmdp", "lmdp", "nobody"])
    def test_in_a_comparison(self, rows, chosen, defined, framework):
        comparison = design_comparison(simulations=1000, pairs=12, **chosen)
        tables = make_tables(self.lost(rows, framework), seed=1)
        totals = tables.failures.group_by("framework").agg(
            pl.col("not_arrived", "timed_out").sum(),
            failed=(pl.col("not_arrived") + pl.col("timed_out")).sum(),
        )
        shown = numbers_of(*vars(tables).values(), totals)
        design = [value for value in vars(comparison).values() if isinstance(value, int | float)]
        text = write_reading(comparison, tables) + write_means(comparison, tables)
        printed = printed_in(text, [*self.DEFINITIONS, *defined])
        assert printed <= printable([*shown, *design])
        assert len(printed) > 50

    def test_and_the_check_sees_them(self):
        assert printed_in("missed .5, 4.4, 12 and 1,500 %") == {".5", "4.4", "12", "1,500"}
        assert "4.4" not in printable([4.45, 44.0])
