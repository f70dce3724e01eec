"""A figure with the data it shows and its text for who does not see it, and its files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import polars as pl

from .style import STYLE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DOTS_PER_INCH = 300


@dataclass(frozen=True, eq=False)
class Drawn:
    """A figure; `data`: the numbers it shows, a row a mark; `alt`: in words what is seen."""

    figure: Figure
    data: pl.DataFrame
    alt: str


def write_figure(drawn: Drawn, folder: Path, name: str) -> None:
    """Write `folder`/<name>.svg, .png and .csv, the same bytes for the same data."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        drawn.figure.savefig(folder / f"{name}.svg", metadata={"Date": None, "Creator": None})
        drawn.figure.savefig(folder / f"{name}.png", dpi=DOTS_PER_INCH, metadata={"Software": None})
    drawn.data.write_csv(folder / f"{name}.csv")
