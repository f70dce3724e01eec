"""The paper's figures of the framework comparison: both measures, and time with failures."""

from typing import Any

import polars as pl
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from policies.experiments.tables import SELECTIONS, Tables, frameworks_of, worlds_of
from policies.pool_sheet import COLOURS as POLICY_COLOURS

COLOURS = {
    **POLICY_COLOURS,
    "polmdp_proper_posterior": "#cc79a7",
    "polmdp_advantage": "#56b4e9",
    "lmdp": "#009e73",
}
NAMES = {
    "polmdp": "PoLMDP",
    "polmdp_proper_posterior": "PoLMDP (proper posterior)",
    "polmdp_advantage": "PoLMDP (advantage)",
    "lmdp": "L-MDP",
    "optimal": "optimal policy",
}
LABELS = {
    "polmdp": "PoLMDP measure,\ndiscounted sum",
    "polmdp_per_step": "PoLMDP measure,\nmean per step",
    "lmdp": "L-MDP measure\n(smaller: more legible)",
    "time_s": "time to a plan, s,\ngoals' solves included",
    "planning_s": "planning alone, s",
}
TITLES = {"balanced": "balanced as in the paper", "all": "all pairs"}
FIGURES = {
    "polmdp": ("polmdp", "polmdp_per_step"),
    "lmdp": ("lmdp",),
    "time": ("time_s", "planning_s"),
}
"""The measures of each figure, a row of panels each; below the times come the failures."""

_MARKED: dict[str, Any] = {"marker": "o", "markersize": 3, "linewidth": 1.2}


def draw_figure(name: str, tables: Tables) -> Figure:
    """One of FIGURES: a row of panels a measure, balanced beside all; below times the failures."""
    measures = FIGURES[name]
    rows = len(measures) + (name == "time")
    figure = Figure(figsize=(7.2, 0.5 + 2.4 * rows), layout="constrained")
    grid = figure.add_gridspec(rows, len(SELECTIONS))
    worlds = worlds_of(tables.means)
    for row, measure in enumerate(measures):
        left = figure.add_subplot(grid[row, 0], ylabel=LABELS[measure])
        right = figure.add_subplot(grid[row, 1], sharey=left)
        if measure.endswith("_s"):
            left.set_yscale("log")
        for axes, selection in zip((left, right), SELECTIONS, strict=True):
            shown = tables.means.filter(measure=measure, selection=selection)
            _draw_means(axes, shown, worlds)
            axes.set_title(f"{TITLES[selection]}, {_counts(shown)}", fontsize=8)
    if name == "time":
        _draw_failures(figure.add_subplot(grid[-1, :]), tables.failures, worlds)
    named: dict[str, Artist] = {}
    for axes in figure.axes:
        lines, labels = axes.get_legend_handles_labels()
        named.update(zip(labels, lines, strict=True))
    figure.legend([*named.values()], [*named], loc="outside lower center", ncols=3, frameon=False)
    return figure


def figure_data(name: str, tables: Tables) -> pl.DataFrame:
    """The numbers that a figure shows, a row a point; shares of failed runs in percent."""
    means = tables.means.filter(pl.col("measure").is_in(FIGURES[name]))
    if name != "time":
        return means
    failures = [
        tables.failures.select(
            *("world", "states", "goals"),
            selection=pl.lit("all"),
            measure=pl.lit(f"{column}_percent"),
            framework="framework",
            n=pl.col("runs").cast(means["n"].dtype),
            mean=100.0 * pl.col(column) / pl.col("runs"),
            low=pl.lit(None, pl.Float64),
            high=pl.lit(None, pl.Float64),
        )
        for column in ("not_arrived", "timed_out")
    ]
    return pl.concat([means, *failures])


def _draw_means(axes: Axes, shown: pl.DataFrame, worlds: pl.DataFrame) -> None:
    """A line a framework with its 95 % band; nothing where balancing kept no pair."""
    places = _name_worlds(axes, worlds)
    for framework in frameworks_of(shown):
        points = shown.filter(pl.col("framework") == framework)
        if points["n"].max() == 0:
            axes.text(0.5, 0.5, "no pairs", ha="center", transform=axes.transAxes)
            return
        colour = COLOURS[framework]
        axes.fill_between(
            places, points["low"], points["high"], color=colour, alpha=0.18, linewidth=0
        )
        axes.plot(places, points["mean"], "-", color=colour, label=NAMES[framework], **_MARKED)


def _draw_failures(axes: Axes, failures: pl.DataFrame, worlds: pl.DataFrame) -> None:
    """Dashed: share that did not arrive; dotted: share that timed out."""
    places = _name_worlds(axes, worlds)
    for column, dashes in (("not_arrived", "--"), ("timed_out", ":")):
        for framework in frameworks_of(failures):
            points = failures.filter(pl.col("framework") == framework)
            share = 100 * points[column] / points["runs"]
            label = f"{NAMES[framework]}, {column.replace('_', ' ')}"
            axes.plot(places, share, dashes, color=COLOURS[framework], label=label, **_MARKED)
    axes.set(ylabel="failed runs, %", ylim=(-4, 104))


def _name_worlds(axes: Axes, worlds: pl.DataFrame) -> list[float]:
    """Places on the x axis, by the number that tells the worlds apart, else side by side."""
    by = next((n for n in ("states", "goals") if worlds[n].n_unique() == len(worlds)), None)
    places = [float(place) for place in (worlds[by] if by else range(len(worlds)))]
    if by == "states":
        axes.set_xscale("log")
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticks(places, worlds["world"].to_list(), rotation=45, ha="right")
    return places


def _counts(shown: pl.DataFrame) -> str:
    fewest, most = min(shown["n"].to_list()), max(shown["n"].to_list())
    return f"{fewest} a world" if fewest == most else f"{fewest} to {most} runs a world"
