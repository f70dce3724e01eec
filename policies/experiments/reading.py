"""What the numbers of a comparison show, in a few sentences and tables made from them."""

from collections.abc import Iterable
from typing import Any

import polars as pl

from policies.experiments.comparison import Comparison
from policies.experiments.figures import FIGURES, NAMES
from policies.experiments.tables import (
    SELECTIONS,
    Tables,
    contrasts_of,
    frameworks_of,
    worlds_of,
)

ALPHA = 0.05
MEASURED = {
    "polmdp": "PoLMDP measure, discounted sum",
    "polmdp_per_step": "PoLMDP measure, mean per step",
    "lmdp": "L-MDP measure",
}
SELECTED = {
    "balanced": "balanced as in the paper",
    "all": "all pairs",
}


def write_reading(comparison: Comparison, tables: Tables) -> str:
    """The reading as Markdown."""
    return "\n".join(
        [
            f"# Frameworks compared: {comparison.name}",
            "",
            _design(comparison),
            "",
            "## What the measures show",
            "",
            f"A framework leads where the paired t test differs from 0 at {ALPHA} after Holm's "
            "correction over the worlds (all pairs that both finished); numbers are by how much "
            "in the mean, with d_z in brackets. More is more legible in the PoLMDP measure, less "
            "in the L-MDP measure.",
            "",
            *(_leads(tables, measure) for measure in MEASURED),
            "## Time",
            "",
            *_time(tables),
            "",
            "## Who arrived",
            "",
            *_failures(comparison, tables),
            "",
            *_about_failures(comparison, tables),
            "",
        ]
    )


def write_means(comparison: Comparison, tables: Tables) -> str:
    """The figures and the tables of means behind the reading, as Markdown."""
    return "\n".join(
        [
            "## Means with 95 % intervals",
            "",
            _FINE_PRINT,
            "",
            *(f"![Figure: {name}]({comparison.name}-figure-{name}.svg)" for name in FIGURES),
            "",
            *(line for selection in SELECTIONS for line in _means(tables, selection)),
        ]
    )


def _design(comparison: Comparison) -> str:
    """What was run, every choice of it."""
    pairs = "listed pairs" if comparison.pairs is None else f"{comparison.pairs} pairs"
    polmdp, variants = comparison.measured_by, comparison.polmdps.values()
    far = "sqrt(1 - b(g)^2)" if comparison.distance == "reported" else f"`{comparison.distance}`"
    chosen = [
        f"Seed {comparison.seed}, {pairs} of start and goal a world; actions `{polmdp.actions}`, "
        f"gamma {polmdp.gamma:g}, at most {_moves(comparison)}.",
        f"PoLMDP with beta {polmdp.beta:g}, formulation `{polmdp.formulation}`"
        f"{', guarded' if polmdp.guard else ''}, r_leg "
        f"{', '.join(f'`{variant.variant}`' for variant in variants)}; the PoLMDP measure sums "
        f"r_leg `{polmdp.variant}` for all.",
        f"L-MDP in mode `{comparison.mode}` with {comparison.simulations:,} simulations a step and "
        f"{comparison.limit_s:g} s a pair; the L-MDP measure's distance is {far}, the beta of its "
        f"observer {comparison.observer_beta:g}.",
    ]
    if comparison.preset:
        chosen.append(f"All this and what has no name is settled by preset `{comparison.preset}`.")
    return " ".join(chosen)


_FINE_PRINT = (
    "Balancing (paper, 4.2.2) drops the slowest pairs of every world until as many remain "
    "everywhere; that selects easy pairs, so all pairs stand beside it. Runs that did not arrive "
    "or timed out are left out of these means, which favours a framework that fails on hard "
    "pairs; the paired differences compare only pairs that both finished. The discounted sum of "
    "positive rewards favours long paths, the mean per step does not. Times are of this machine, "
    "by the wall's clock; the paper timed the planning alone."
)


def _leads(tables: Tables, measure: str) -> str:
    """For each pair of frameworks: who leads in which worlds, by how much, and where nobody."""
    lines = [f"**{MEASURED[measure]}.**"]
    for framework, against in contrasts_of(tables.means):
        tests = tables.differences.filter(
            pl.col("selection") == "all",
            pl.col("measure") == measure,
            pl.col("framework") == framework,
            pl.col("against") == against,
        )
        better = 1 if measure.startswith("polmdp") else -1
        shown = pl.col("p_t_holm") < ALPHA
        ahead = tests.filter(shown & (pl.col("mean") * better > 0))
        behind = tests.filter(shown & (pl.col("mean") * better < 0))
        open_still = tests.filter(~shown)["world"].to_list()
        parts = []
        for leader, won in ((framework, ahead), (against, behind)):
            if len(won):
                parts.append(f"{NAMES[leader]} leads in {_named(won.iter_rows(named=True))}")
        if open_still:
            parts.append(f"no difference shown in {', '.join(open_still)}")
        lines.append(f"- {NAMES[framework]} against {NAMES[against]}: {'; '.join(parts)}.")
    return "\n".join([*lines, ""])


def _named(tests: Iterable[dict[str, Any]]) -> str:
    return ", ".join(f"{t['world']} by {abs(t['mean']):.3f} ({abs(t['d_z']):.2f})" for t in tests)


def _time(tables: Tables) -> list[str]:
    heads = ("world", "goals' solves included", "planning alone")
    lines = []
    for framework in frameworks_of(tables.ratios):
        rows = [
            (row["world"], f"{row['time_ratio']:,.3g}", f"{row['planning_ratio']:,.3g}")
            for row in tables.ratios.filter(framework=framework).iter_rows(named=True)
        ]
        lead = f"Mean time of L-MDP over that of {NAMES[framework]}, all runs (a timed out one "
        lines += [f"{lead}until its limit).", "", *_table(heads, rows), ""]
    return lines[:-1]


def _failures(comparison: Comparison, tables: Tables) -> list[str]:
    """A row a world: of each framework, how many runs did not arrive and how many timed out."""
    frameworks, rows = frameworks_of(tables.failures), []
    for world in worlds_of(tables.failures)["world"]:
        of_it = tables.failures.filter(pl.col("world") == world)
        cells = []
        for framework in frameworks:
            each = of_it.row(by_predicate=pl.col("framework") == framework, named=True)
            cells.append(f"{each['not_arrived']} + {each['timed_out']} of {each['runs']}")
        rows.append((world, *cells))
    return [
        f"Runs that did not arrive within {_moves(comparison)} + runs that timed out.",
        "",
        *_table(("world", *(NAMES[framework] for framework in frameworks)), rows),
    ]


def _about_failures(comparison: Comparison, tables: Tables) -> list[str]:
    """What kind of failures there were: this run's, no other's."""
    counted = tables.failures.group_by("framework").agg(pl.col("not_arrived", "timed_out").sum())
    kinds = {framework: (lost, late) for framework, lost, late in counted.iter_rows()}
    lost, late = kinds["lmdp"]
    said = []
    for framework, parameters in comparison.polmdps.items():
        loitered, _ = kinds[framework]
        if loitered and parameters.formulation == "reward" and not parameters.guard:
            said.append(
                f"{NAMES[framework]}'s {loitered} failures loitered where r_leg is high: positive "
                "rewards and a goal that does not end the task promise no arrival. The paper "
                "counts timeouts only."
            )
    if lost + late == 0:
        return [*said, "L-MDP did not fail."]
    said.append(
        f"Of L-MDP's {lost + late} failures {late} are of time and {lost} of wandering: it went "
        "on acting and did not get there."
    )
    if comparison.mode == "as_reported":
        said.append(
            "Mode `as_reported` is the baseline as the paper's authors ran it: a bandit of the "
            "next actions, whose index explores the wrong way, with the belief forgotten at every "
            "step. Its wandering says nothing of how hard POMDPs are."
        )
    return said


def _moves(comparison: Comparison) -> str:
    """Within what a run must have arrived."""
    return f"{comparison.most_moves or '4 x distance / .85'} moves"


def _means(tables: Tables, selection: str) -> list[str]:
    frameworks, lines = frameworks_of(tables.means), []
    for measure, name in {**MEASURED, "time_s": "Time to a plan, s"}.items():
        shown = tables.means.filter(pl.col("selection") == selection, pl.col("measure") == measure)
        rows = []
        for world in worlds_of(shown)["world"]:
            of_it = shown.filter(pl.col("world") == world)
            cells = (
                of_it.row(by_predicate=pl.col("framework") == framework, named=True)
                for framework in frameworks
            )
            rows.append((world, *(_interval(cell) for cell in cells)))
        heads = ("world", *(NAMES[framework] for framework in frameworks))
        lines += [f"{name}, {SELECTED[selection]} (n):", "", *_table(heads, rows), ""]
    return lines


def _interval(cell: dict[str, float]) -> str:
    if not cell["n"]:
        return "none"
    if cell["n"] == 1:
        return f"{cell['mean']:.3g} (1)"
    return f"{cell['mean']:.3g} [{cell['low']:.3g}, {cell['high']:.3g}] ({cell['n']})"


def _table(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> list[str]:
    lines = [f"| {' | '.join(row)} |" for row in (heads, *rows)]
    return [lines[0], "|---" * (lines[0].count("|") - 1) + "|", *lines[1:]]
