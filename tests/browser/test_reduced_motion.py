"""Reduced motion, as it is drawn and as it is stored."""

from typing import Any

import pytest

from tests.browser import walk
from tests.browser.conftest import STEP_MS, Site, Visit

# Notes beside the study's code what is drawn, in cells: where the robot is, how wide the ring.
WITNESS = """
    window.drawn = { robots: [], rings: [] };
    const { translate, arc } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.translate = function (x, y) {
        if (this.canvas.id === "maze" && x > 0) drawn.robots.push([y - 0.5, x - 0.5]);
        translate.call(this, x, y);
    };
    CanvasRenderingContext2D.prototype.arc = function (x, y, radius, ...angles) {
        if (this.canvas.id === "maze") drawn.rings.push(radius);
        arc.call(this, x, y, radius, ...angles);
    };
"""


@pytest.mark.parametrize("wish", ["reduce", "no-preference"])
def test_the_robot_jumps_from_cell_to_cell_for_whoever_wishes_it_and_the_row_says_so(
    site: Site, visit: Visit, wish: Any
):
    page = visit(reduced_motion=wish)
    page.add_init_script(WITNESS)
    walk.reach_trials(page)
    path = walk.trial(page)["playback"]["path"]
    walk.play(page, 4 * STEP_MS)
    walk.stop(page)
    drawn = page.evaluate("drawn")
    walk.answer(page, "F", 6)
    walk.round_is(page, 2)
    (row,) = site.trials()
    reduced = wish == "reduce"
    assert row["reduced_motion"] == reduced
    assert all(robot in path for robot in drawn["robots"]) == reduced
    assert drawn["robots"][-1] != drawn["robots"][0]
    assert (max(drawn["rings"]) < 1) == reduced
