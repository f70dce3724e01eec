import numpy as np
import pytest

from policies import ACTION_SETS, Action, Parameters, parse_maze, plan_legible
from policies.drawing import (
    arrows,
    describe,
    draw_beliefs,
    draw_path,
    draw_plan,
    draw_policy,
    in_encoding,
)

ACTIONS = ACTION_SETS["udlrn"]
MAZE = parse_maze("+---+---+\n| A | B |\n+   +   +\n| .   . |\n+---+---+\n")


@pytest.mark.parametrize(
    ("taken", "sign"),
    [
        ("UP", "↑"),
        ("DOWN", "↓"),
        ("LEFT", "←"),
        ("RIGHT", "→"),
        ("NOOP", "o"),
        ("UP LEFT", "↑←"),
        ("UP DOWN", "↕"),
        ("LEFT RIGHT", "↔"),
        ("UP DOWN LEFT", "↕←"),
        ("DOWN LEFT RIGHT", "↓↔"),
        ("UP DOWN LEFT RIGHT", "↕↔"),
        ("NOOP RIGHT", "o→"),
        ("NOOP UP RIGHT", "*"),
    ],
)
def test_tied_actions_are_shown_together(taken, sign):
    assert arrows({Action[name] for name in taken.split()}) == sign


def test_a_policy_is_drawn_in_its_maze():
    plan = plan_legible(MAZE, "A")
    assert draw_policy(MAZE, plan.policy_optimal, ACTIONS) == [
        "+--+--+",
        "|A |B |",
        "+  +  +",
        "|↑  ← |",
        "+--+--+",
    ]


def test_two_maps_stand_side_by_side_where_they_fit():
    plan = plan_legible(MAZE, "A")
    wide = draw_plan(plan, ACTIONS, columns=80).splitlines()
    assert wide[0].split("   ") == ["optimal policy to A", "legible policy to A"]
    assert len(wide) == 6
    narrow = draw_plan(plan, ACTIONS, columns=30).splitlines()
    assert len(narrow) == 13
    assert narrow[7] == "legible policy to A"


def test_ten_by_ten_fits_80_columns(draw_maze):
    plan = plan_legible(draw_maze(10, 10, 6), "A")
    lines = draw_plan(plan, ACTIONS, columns=80).splitlines()
    assert len(lines) == 22
    assert max(map(len, lines)) <= 80


def test_arrows_become_plain_signs_where_the_output_has_none():
    assert in_encoding("↑↓←→↕↔", "ascii") == "^v<>:="
    assert in_encoding("↑↓←→↕↔", None) == "^v<>:="
    assert in_encoding("↑↓", "utf-8") == "↑↓"


def test_a_path_shows_the_step_that_first_entered_a_cell():
    assert draw_path(MAZE, [0, 2, 2, 3, 1]).splitlines() == [
        "+---+---+",
        "| A0| B4|",
        "+   +   +",
        "| 1   3 |",
        "+---+---+",
    ]


def test_beliefs_are_a_row_per_step_with_a_mark_for_standing():
    beliefs = np.array([[0.5, 0.5], [0.5, 0.5], [0.0, 1.0]])
    lines = draw_beliefs(MAZE, [2, 2, 3], beliefs, "B").splitlines()
    assert len(lines) == 4
    assert lines[2].startswith("   1.  2,1")
    assert lines[3].endswith("#" * 20)


def test_a_certified_plan_is_said_to_be():
    lines = describe(plan_legible(MAZE, "A"))
    assert "optimal 2.35, legible 2.35" in lines[0]
    assert lines[1].startswith("certified: arrives from every start")


def test_a_plan_that_fails_is_said_to_with_a_start(draw_maze):
    maze = draw_maze(25, 25, 3, seed=1)
    plan = plan_legible(maze, "A", Parameters(gamma=0.5))
    fails = np.flatnonzero(~plan.certificate.holds_at)
    i, j = divmod(int(fails[0]), 25)
    said = describe(plan)[1]
    assert said.startswith(f"not certified: from {len(fails)} of 624 starts, ")
    assert f"row {i + 1} column {j + 1}" in said


def test_a_maze_of_one_cell_has_no_starts():
    one = parse_maze("+---+\n| A |\n+---+\n")
    assert describe(plan_legible(one, "A")) == ["no start but the goal itself"]
