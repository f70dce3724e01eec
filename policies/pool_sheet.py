"""The whole pool on one page: paths side by side, belief curves below."""

from io import BytesIO
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import MaxNLocator

from policies.maze import Maze
from policies.pool import CONDITIONS, Pool, Scenario, Scene, Stimulus, load_pool
from policies.pool_build import SURE, beliefs, package_mazes

UNDATED: dict[str, dict[str, Any]] = {
    ".svg": {"Date": None},
    ".png": {},
    ".pdf": {"CreationDate": None},
}
FORMATS = tuple(UNDATED)
ACROSS = 5
COLOURS = {"polmdp": "#0072b2", "optimal": "#d55e00"}


def draw_sheet(suffix: str, pool: Pool | None = None) -> bytes:
    """The page as the bytes of an image file; `suffix` is one of `FORMATS`."""
    pool = pool or load_pool()
    mazes = package_mazes()
    down = -(-len(pool.scenarios) // ACROSS)
    # A fixed salt and no date: the same pool gives the same file.
    with mpl.rc_context({"svg.hashsalt": "goalguess", "font.size": 7}):
        page = Figure(figsize=(3.6 * ACROSS, 3.1 * down))
        places = page.subfigures(down, ACROSS, squeeze=False)
        for place, scenario in zip(places.flat, pool.scenarios, strict=False):
            _draw_scenario(place, pool, scenario, mazes[scenario.maze])
        image = BytesIO()
        page.savefig(image, format=suffix[1:], dpi=80, metadata=UNDATED[suffix])
    return image.getvalue()


def _draw_scenario(place: SubFigure, pool: Pool, scenario: Scenario, maze: Maze) -> None:
    """Both rollouts of a scenario, and an observer's belief in the true goal at every step."""
    place.suptitle(f"{scenario.id}  {scenario.maze}, goal {scenario.goal}", y=0.98)
    curve = place.add_axes((0.1, 0.1, 0.85, 0.22))
    n = maze.goal_index(scenario.goal)
    for left, condition in zip((0.03, 0.52), CONDITIONS, strict=True):
        shown = pool.stimulus(scenario.id, condition)
        picture = place.add_axes((left, 0.36, 0.45, 0.5))
        picture.set_title(f"{condition}, {shown.steps} steps", color=COLOURS[condition], pad=2)
        draw_rollout_picture(picture, pool.scenes[scenario.maze], shown)
        belief = beliefs(maze, shown.cells)[:, n]
        curve.plot(belief, color=COLOURS[condition], marker=".", markersize=3, linewidth=1)
    curve.axhline(SURE, color="0.6", linewidth=0.5, linestyle=":")
    curve.xaxis.set_major_locator(MaxNLocator(integer=True))
    curve.set(ylim=(-0.03, 1.03), yticks=(0, SURE, 1))


def draw_rollout_picture(axes: Axes, scene: Scene, shown: Stimulus) -> None:
    """Walls, lettered areas and the path, dark to light in time; a ring is the start."""
    axes.set(xlim=(-0.1, scene.cols + 0.1), ylim=(scene.rows + 0.1, -0.1), aspect="equal")
    axes.axis("off")
    walls = [((x1, y1), (x2, y2)) for x1, y1, x2, y2 in scene.walls]
    axes.add_collection(LineCollection(walls, colors="black", linewidths=1))
    for area in scene.areas:
        i, j = divmod(area.cell, scene.cols)
        bold = "bold" if area.letter == shown.goal else "normal"
        axes.text(j + 0.5, i + 0.5, area.letter, ha="center", va="center", weight=bold)
    rows, cols = np.divmod(np.array(shown.cells), scene.cols)
    # A drift down to the right keeps a way back apart from the way there.
    drift = np.linspace(-0.12, 0.12, len(rows))
    points = np.stack([cols + 0.5 + drift, rows + 0.5 + drift], axis=1)
    steps = np.stack([points[:-1], points[1:]], axis=1)
    axes.add_collection(
        LineCollection(list(steps), array=np.arange(len(steps)), cmap="viridis", linewidths=1.6)
    )
    axes.plot(*points[0], marker="o", markerfacecolor="none", color="black", markersize=5)
