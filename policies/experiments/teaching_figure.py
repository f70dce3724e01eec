"""The figure of the teaching experiment: ratio correct against the number of examples."""

import polars as pl
from matplotlib.figure import Figure

from policies.experiments.teaching import EXAMPLES, TeachingDesign
from policies.experiments.teaching_tables import TeachingTables
from policies.pool import CONDITIONS
from policies.pool_sheet import COLOURS

TEACHERS = {"polmdp": "PoLMDP", "optimal": "optimal policy"}
LESSONS = {"sequences": "Sequences", "samples": "Unconnected samples"}
LEARNERS = {"bayes": "exact Bayes", "gradient": "gradient IRL"}


def draw_teaching(design: TeachingDesign, tables: TeachingTables) -> Figure:
    """A line a teacher with its 95 % band; dotted, what guessing gives."""
    figure = Figure(figsize=(4.6, 3.4), layout="constrained")
    axes = figure.add_subplot(
        title=f"{LESSONS[design.lessons]}, {LEARNERS[design.predictor]}, eta {design.eta:g}",
        xlabel="examples seen, k",
        ylabel="ratio of goals named correctly",
        xlim=(0.5, EXAMPLES + 0.5),
        ylim=(0, 1.02),
        xticks=[1, *range(5, EXAMPLES + 1, 5)],
    )
    for teacher in CONDITIONS:
        curve = tables.ratios.filter(pl.col("teacher") == teacher)
        axes.fill_between(
            curve["k"], curve["low"], curve["high"], color=COLOURS[teacher], alpha=0.2, linewidth=0
        )
        axes.plot(
            curve["k"],
            curve["ratio"],
            marker=".",
            linewidth=1.2,
            color=COLOURS[teacher],
            label=TEACHERS[teacher],
        )
    axes.axhline(tables.chance, color="0.4", linewidth=0.8, linestyle=":", label="by chance")
    axes.legend(loc="lower right", frameon=False)
    return figure
