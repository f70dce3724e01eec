import json
import subprocess
import sys
from dataclasses import FrozenInstanceError
from importlib.resources import files

import pytest

from policies import CONDITIONS, StimulusError, load_pool, parse_pool
from policies.pool import content_hash

POOL = load_pool()
TEXT = files("policies").joinpath("stimuli/pool.json").read_text(encoding="utf-8")


def test_has_37_scenarios_with_a_stimulus_per_condition():
    assert len(POOL.scenarios) == 37
    assert len(POOL.stimuli) == 74
    for scenario in POOL.scenarios:
        for condition in CONDITIONS:
            shown = POOL.stimulus(scenario.id, condition)
            assert (shown.scenario, shown.condition) == (scenario.id, condition)
            assert (shown.maze, shown.goal) == (scenario.maze, scenario.goal)
            assert shown.cells[0] == scenario.start


def test_a_stimulus_ends_in_its_goals_area():
    for shown in (*POOL.stimuli.values(), POOL.practice):
        areas = {area.letter: area.cell for area in POOL.scenes[shown.maze].areas}
        assert shown.cells[-1] == areas[shown.goal]
        assert shown.steps == len(shown.cells) - 1


def test_stimuli_are_found_by_id():
    assert all(POOL.stimuli[key].id == key for key in POOL.stimuli)


def test_ids_name_neither_condition_nor_scenario_nor_goal():
    for shown in (*POOL.stimuli.values(), POOL.practice):
        assert len(shown.id) == 12
        assert set(shown.id) <= set("0123456789abcdef")


def test_practice_belongs_to_neither_condition():
    assert POOL.practice.condition not in CONDITIONS
    assert POOL.practice.id not in POOL.stimuli
    assert POOL.practice.maze not in {scenario.maze for scenario in POOL.scenarios}


@pytest.mark.parametrize(("scenario", "condition"), [("s99", "optimal"), ("s01", "other")])
def test_an_unknown_stimulus_is_answered_with_what_is_expected(scenario, condition):
    with pytest.raises(StimulusError, match=f"polmdp, optimal; came '{scenario}' and"):
        POOL.stimulus(scenario, condition)


def test_a_scene_is_a_closed_box_with_six_areas():
    for scene in POOL.scenes.values():
        assert len(scene.areas) == 6
        assert [area.letter for area in scene.areas] == list("ABCDEF")
        w, h = scene.cols, scene.rows
        assert {(0, 0, w, 0), (0, h, w, h), (0, 0, 0, h), (w, 0, w, h)} <= set(scene.walls)
        assert all((x1 == x2) != (y1 == y2) for x1, y1, x2, y2 in scene.walls)


def test_nothing_of_it_can_be_changed():
    with pytest.raises(FrozenInstanceError):
        POOL.practice.goal = "A"  # type: ignore[misc]
    with pytest.raises(TypeError):
        POOL.stimuli["x"] = POOL.practice  # type: ignore[index]


def test_the_hash_is_of_the_content_not_of_line_ends_or_layout():
    assert parse_pool(TEXT.replace("\n", "\r\n")).hash == POOL.hash
    assert parse_pool(json.dumps(json.loads(TEXT), indent=4)).hash == POOL.hash
    turned = dict(reversed(json.loads(TEXT).items()))
    assert parse_pool(json.dumps(turned)).hash == POOL.hash
    assert POOL.hash == content_hash(json.loads(TEXT))


def test_the_hash_changes_with_the_content():
    content = json.loads(TEXT)
    content["stimuli"][0]["cells"][1] += 1
    assert parse_pool(json.dumps(content)).hash != POOL.hash


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "JSONDecodeError"),
        ("[]", "TypeError"),
        ("{}", "KeyError: 'stimuli'"),
        ('{"stimuli": [{"id": "x"}]}', "cells"),
        (TEXT.replace('"start"', '"begin"'), "begin"),
        (TEXT.replace('"walls": [[0, ', '"walls": [['), "ValueError"),
    ],
)
def test_a_damaged_file_is_one_clear_error(text, said):
    with pytest.raises(StimulusError, match=r"pool\.json: expected .*" + said):
        parse_pool(text)


def test_reading_it_loads_no_numerical_library():
    code = (
        "import sys; from policies import load_pool, CONDITIONS, PolicyError; load_pool();"
        "sys.exit(any(m in sys.modules for m in ('numpy', 'scipy', 'matplotlib', 'typer')))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
