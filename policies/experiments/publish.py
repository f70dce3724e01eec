"""From the rows of a comparison to its files: tables, figures and the reading."""

from functools import partial
from pathlib import Path

from policies.command_line import write_whole
from policies.experiments.comparison import Comparison
from policies.experiments.figures import FIGURES, draw_figure, figure_data
from policies.experiments.images import draw_images
from policies.experiments.reading import write_means, write_reading
from policies.experiments.tables import make_tables, read_rows


def publish_comparison(file: Path, comparison: Comparison) -> str:
    """Write all that is made from the rows in `file` beside it; returns the reading (Markdown).

    `<name>-means.csv`, `-failures.csv`, `-differences.csv`, `-ratios.csv`; of each figure .svg,
    .png and .csv; and `<name>.md`.
    """
    tables = make_tables(read_rows(file), comparison.seed)
    reading = write_reading(comparison, tables)
    contents: dict[str, str | bytes] = {
        ".md": f"{reading}\n{write_means(comparison, tables)}",
        "-means.csv": tables.means.write_csv(),
        "-failures.csv": tables.failures.write_csv(),
        "-differences.csv": tables.differences.write_csv(),
        "-ratios.csv": tables.ratios.write_csv(),
    }
    for name in FIGURES:
        contents[f"-figure-{name}.csv"] = figure_data(name, tables).write_csv()
        for suffix, image in draw_images(partial(draw_figure, name, tables)).items():
            contents[f"-figure-{name}{suffix}"] = image
    write_whole({file.with_name(file.stem + end): each for end, each in contents.items()})
    return reading
