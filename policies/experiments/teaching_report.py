"""From the rows of a teaching experiment to its files: tables, figure and a summary."""

from pathlib import Path

import polars as pl

from policies.command_line import write_whole
from policies.experiments.images import draw_images
from policies.experiments.teaching import TeachingDesign
from policies.experiments.teaching_figure import draw_teaching
from policies.experiments.teaching_tables import TeachingTables, make_teaching_tables

PAPER = {
    ("samples", "polmdp"): (0.382, 0.776, 0.912, 0.972),
    ("samples", "optimal"): (0.339, 0.691, 0.869, 0.951),
    ("sequences", "polmdp"): (0.374, 0.651, 0.919, 0.998),
    ("sequences", "optimal"): (0.329, 0.622, 0.903, 0.994),
}
"""Ratios that the authors published, after TOLD examples; other mazes and another learner."""
TOLD = (1, 5, 10, 20)


def publish_teaching(file: Path, design: TeachingDesign) -> str:
    """Write all that is made from the rows in `file` beside it; returns a summary (Markdown).

    Of `<lessons>-<predictor>`: -ratios.csv, which the figure shows, -differences.csv, .svg, .png.
    """
    tables = make_teaching_tables(file)
    contents: dict[str, str | bytes] = {
        "-ratios.csv": tables.ratios.write_csv(),
        "-differences.csv": tables.differences.write_csv(),
        **draw_images(lambda: draw_teaching(design, tables)),
    }
    write_whole({file.with_name(file.stem + end): each for end, each in contents.items()})
    return summarise(design, tables)


def summarise(design: TeachingDesign, tables: TeachingTables) -> str:
    """A table of the ratios correct after TOLD examples, the paper's in brackets."""
    lines = [
        "| k | PoLMDP [95 %] (paper) | optimal [95 %] (paper) | difference [95 %] | p (Holm) |",
        "|---|---|---|---|---|",
    ]
    for place, k in enumerate(TOLD):
        cells = [str(k)]
        for teacher in ("polmdp", "optimal"):
            paper = PAPER[design.lessons, teacher][place]
            ratio = tables.ratios.row(
                by_predicate=(pl.col("teacher") == teacher) & (pl.col("k") == k), named=True
            )
            cells.append(
                f"{ratio['ratio']:.3f} [{ratio['low']:.3f}, {ratio['high']:.3f}] ({paper:.3f})"
            )
        ahead = tables.differences.row(by_predicate=pl.col("k") == k, named=True)
        cells.append(f"{ahead['difference']:+.3f} [{ahead['low']:+.3f}, {ahead['high']:+.3f}]")
        cells.append(f"{ahead['p_holm']:.2g}")
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)
