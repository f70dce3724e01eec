from dataclasses import replace

import pytest
from matplotlib.figure import Figure

from policies import load_pool
from policies.pool_sheet import FORMATS, draw_rollout_picture, draw_sheet

POOL = load_pool()
FEW = replace(POOL, scenarios=POOL.scenarios[:2])

BEGINS = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}


@pytest.mark.parametrize("suffix", FORMATS)
def test_draws_each_format(suffix):
    assert draw_sheet(suffix, FEW).startswith(BEGINS[suffix])


def test_the_same_pool_gives_the_same_file():
    assert draw_sheet(".svg", FEW) == draw_sheet(".svg", FEW)


def test_names_every_scenario_and_both_conditions():
    text = draw_sheet(".svg", FEW).decode()
    for scenario in FEW.scenarios:
        assert f"{scenario.id}  {scenario.maze}, goal {scenario.goal}" in text
        for condition in ("polmdp", "optimal"):
            shown = POOL.stimulus(scenario.id, condition)
            assert f"{condition}, {shown.steps} steps" in text


def test_a_picture_has_all_walls_areas_and_steps():
    shown = POOL.stimulus("s01", "polmdp")
    scene = POOL.scenes[shown.maze]
    axes = Figure().add_subplot()
    draw_rollout_picture(axes, scene, shown)
    walls, path = axes.collections
    assert len(walls.get_paths()) == len(scene.walls)
    assert len(path.get_paths()) == shown.steps
    assert [text.get_text() for text in axes.texts] == list("ABCDEF")
