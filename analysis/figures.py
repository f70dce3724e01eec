"""The paper's three figures: correct guesses, time of prediction, confidence.

Drawn without pyplot, so that nothing global is touched, and without dates or random ids, so
that the same data give the same bytes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .as_in_paper import PaperBlock
from .contract import CONDITIONS, LABELS, REFERENCE, TREATMENT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIZE_INCHES = (4.4, 3.9)
DOTS_PER_INCH = 220

COLOURS = {TREATMENT: "#0072B2", REFERENCE: "#E69F00"}
"""Blue and orange of Okabe and Ito, told apart with every kind of colour vision, and in grey."""

_INK = "#222222"
_STYLE: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 10,
    "axes.edgecolor": _INK,
    "axes.labelcolor": _INK,
    "text.color": _INK,
    "xtick.color": _INK,
    "ytick.color": _INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.grid": True,
    "axes.grid.axis": "y",
    "grid.color": "#E3E3E3",
    "grid.linewidth": 0.8,
    "xtick.bottom": False,
    "svg.hashsalt": "goalguess",
    "svg.fonttype": "path",
}
_WIDTH = 0.55


def figure_correct(block: PaperBlock) -> Figure:
    """Percentage of correct guesses per condition from 0 to 100, with Wilson's 95 % interval."""
    with _panel("Correct guesses, %", "Bar: share; whisker: 95 % interval") as (figure, axes):
        shares = [block.correct.arms[arm] for arm in CONDITIONS]
        _bars(
            axes,
            [100 * each.share for each in shares],
            [(100 * each.low, 100 * each.high) for each in shares],
            "{:.1f} %",
        )
        axes.set_ylim(0, 100)
        axes.set_yticks(range(0, 101, 20))
        _name_arms(axes, [each.n for each in shares])
    return figure


def figure_prediction_time(block: PaperBlock) -> Figure:
    """Mean time of prediction per condition from 0 s, with the t interval at 95 %."""
    from matplotlib.ticker import MaxNLocator

    with _panel("Time of prediction, s", "Bar: mean; whisker: 95 % interval") as (figure, axes):
        means = [block.prediction_time.arms[arm] for arm in CONDITIONS]
        intervals = [
            (
                each.mean if each.low is None else each.low,
                each.mean if each.high is None else each.high,
            )
            for each in means
        ]
        _bars(axes, [each.mean for each in means], intervals, "{:.2f} s")
        axes.set_ylim(0, 1.12 * max(high for _, high in intervals) or 1)
        axes.yaxis.set_major_locator(MaxNLocator(nbins=6, steps=[1, 2, 5, 10]))
        _name_arms(axes, [each.n for each in means])
    return figure


def figure_confidence(values: Sequence[NDArray[np.float64]]) -> Figure:
    """Box plot of confidence, 1 to 7, from each condition's values in order, NaN left out.

    Box: quartiles; thick line: median; dot: mean; whiskers: to the last value within 1.5 box
    heights; rings: values beyond.
    """
    present = [each[~np.isnan(each)] for each in values]
    with _panel(
        "Confidence, 1 (not at all sure) to 7 (completely)",
        "Dot: mean; thick line: median; box: quartiles",
    ) as (figure, axes):
        drawn = axes.boxplot(
            present,
            positions=range(len(present)),
            widths=_WIDTH,
            patch_artist=True,
            showmeans=True,
            medianprops={"color": _INK, "linewidth": 3.5, "solid_capstyle": "butt"},
            meanprops={
                "marker": "o",
                "markersize": 7,
                "markerfacecolor": "white",
                "markeredgecolor": _INK,
                "markeredgewidth": 1.4,
            },
            flierprops={"marker": "o", "markersize": 4, "markeredgecolor": "#777777"},
            whiskerprops={"color": _INK},
            capprops={"color": _INK},
            boxprops={"edgecolor": _INK},
        )
        for arm, box in zip(CONDITIONS, drawn["boxes"], strict=True):
            box.set_facecolor(COLOURS[arm])
        axes.set_ylim(0.6, 7.4)
        axes.set_yticks(range(1, 8))
        _name_arms(axes, [len(each) for each in present])
    return figure


def save(figure: Figure, folder: Path, name: str) -> None:
    """Write the figure as `folder`/<name>.svg and .png, the same bytes for the same figure."""
    import matplotlib

    with matplotlib.rc_context(_STYLE):
        figure.savefig(folder / f"{name}.svg", metadata={"Date": None, "Creator": None})
        figure.savefig(folder / f"{name}.png", dpi=DOTS_PER_INCH, metadata={"Software": None})


@contextmanager
def _panel(label: str, key: str) -> Iterator[tuple[Figure, Axes]]:
    """Give an empty panel in our style, with `label` at its y axis and `key` above it."""
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(_STYLE):
        figure = Figure(figsize=SIZE_INCHES, layout="constrained")
        axes = figure.add_subplot()
        axes.set_ylabel(label)
        axes.set_title(key, loc="left", fontsize=9, color="#555555", pad=16)
        yield figure, axes


def _bars(
    axes: Axes, heights: list[float], intervals: list[tuple[float, float]], form: str
) -> None:
    places = range(len(heights))
    axes.bar(places, heights, _WIDTH, color=[COLOURS[arm] for arm in CONDITIONS])
    below = [height - low for height, (low, _) in zip(heights, intervals, strict=True)]
    above = [high - height for height, (_, high) in zip(heights, intervals, strict=True)]
    axes.errorbar(
        places, heights, yerr=[below, above], fmt="none", ecolor=_INK, elinewidth=1.6, capsize=6
    )
    for place, height, (_, high) in zip(places, heights, intervals, strict=True):
        axes.annotate(
            form.format(height),
            (place, high),
            xytext=(0, 5),
            textcoords="offset points",
            ha="center",
            fontweight="bold",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5},
            annotation_clip=False,
        )


def _name_arms(axes: Axes, n: list[int]) -> None:
    """Write each condition with its number of trials below the axis."""
    labels = [LABELS[arm][0].upper() + LABELS[arm][1:] for arm in CONDITIONS]
    names = [f"{label}\nn = {count:,} trials" for label, count in zip(labels, n, strict=True)]
    axes.set_xticks(range(len(n)), names)
    axes.set_xlim(-0.6, len(n) - 0.4)
