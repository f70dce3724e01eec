import pytest

from policies import Maze, ModelError, parse_maze
from policies.experiments.pairs_file import with_listed_pairs
from policies.experiments.worlds import Pair, World

WIDE = """\
+---+---+---+
| A   .   . |
+   +---+   +
| .   . | B |
+---+---+---+
"""
HEAD = "maze,row,column,goal\n"


@pytest.fixture
def worlds():
    """A maze twice; in `closed` walls enclose the cell in the middle of the first row."""
    maze = parse_maze(WIDE)
    walls, below = maze.wall_right.copy(), maze.wall_below.copy()
    walls[0] = True
    closed = Maze(2, 3, {"A": 0, "B": 5}, walls, below)
    return [World("wide", maze), World("closed", closed)]


def listed(worlds, tmp_path, text):
    file = tmp_path / "pairs.csv"
    file.write_text(text, encoding="utf-8")
    return with_listed_pairs(worlds, file)


def test_rows_and_columns_count_from_one_at_the_top_left(worlds, tmp_path):
    (world,) = listed(worlds, tmp_path, f"{HEAD}wide,1,2,A\nwide,2,1,B\n")
    assert world.name == "wide"
    assert world.pairs == (Pair(0, 1, "A"), Pair(1, 3, "B"))


def test_mazes_that_no_line_names_are_left_out_and_the_others_keep_their_order(worlds, tmp_path):
    both = listed(worlds, tmp_path, f"{HEAD}closed,2,1,A\nwide,1,2,A\n")
    assert [world.name for world in both] == ["wide", "closed"]
    assert [len(world.pairs) for world in both] == [1, 1]


def test_a_mark_of_the_spreadsheet_and_its_line_ends_are_no_error(worlds, tmp_path):
    (world,) = listed(worlds, tmp_path, "\ufeffmaze,row,column,goal\r\nwide,1,2,A\r\n")
    assert world.pairs == (Pair(0, 1, "A"),)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", r"pairs\.csv:1: expected the columns maze,row,column,goal, came "),
        ("maze,column,row,goal\n", "came maze,column,row,goal"),
        (HEAD, r"pairs\.csv:2: expected at least one pair, found none"),
        (f"{HEAD}wide,1,2,A\nwide,1,2\n", r"pairs\.csv:3: expected 4 cells in each line"),
        (f"{HEAD}wide,1,2,A,x\n", r"pairs\.csv:2: expected 4 cells in each line"),
        (f"{HEAD}narrow,1,2,A\n", r"pairs\.csv:2: expected one of the mazes wide, closed; came 'n"),
        (f"{HEAD}wide,0,2,A\n", r"pairs\.csv:2: expected a row from 1 to 2, came '0'"),
        (f"{HEAD}wide,3,2,A\n", "expected a row from 1 to 2, came '3'"),
        (f"{HEAD}wide,1,4,A\n", "expected a column from 1 to 3, came '4'"),
        (f"{HEAD}wide,1,x,A\n", "expected a column from 1 to 3, came 'x'"),
        (f"{HEAD}wide,1,2,C\n", r"pairs\.csv:2: expected a goal of the maze \(A B\), came 'C'"),
        (f"{HEAD}wide,1,1,A\n", "expected a start away from goal A, came its cell 1,1"),
        (f"{HEAD}closed,1,2,A\n", "expected a start with a way to goal A, came the enclosed cell"),
        (f"{HEAD}closed,1,3,A\n", "expected a start with a way to goal A, came the enclosed cell"),
    ],
)
def test_an_error_names_the_line_and_what_was_expected(worlds, tmp_path, text, said):
    with pytest.raises(ModelError, match=said):
        listed(worlds, tmp_path, text)


def test_bytes_that_are_no_text_are_refused(worlds, tmp_path):
    file = tmp_path / "pairs.csv"
    file.write_bytes(b"maze,row,column,goal\nwide,\xff,2,A\n")
    with pytest.raises(ModelError, match=r"pairs\.csv: expected text in UTF-8"):
        with_listed_pairs(worlds, file)
