import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from policies import (
    Action,
    MazeError,
    PolicyError,
    format_maze,
    parse_maze,
    random_maze,
)

SMALL = """\
+---+---+---+
| A   .   . |
+   +---+   +
| .   . | B |
+---+---+---+
"""


def put(line: int, column: int, text: str) -> str:
    """SMALL with `text` written at a 1-based line and column."""
    lines = SMALL.splitlines()
    old = lines[line - 1]
    lines[line - 1] = old[: column - 1] + text + old[column - 1 + len(text) :]
    return "\n".join(lines)


def message(text: str) -> str:
    with pytest.raises(MazeError) as caught:
        parse_maze(text, source="small.txt")
    return str(caught.value)


def same(one, other) -> bool:
    return (
        (one.rows, one.cols, dict(one.goals)) == (other.rows, other.cols, dict(other.goals))
        and np.array_equal(one.wall_right, other.wall_right)
        and np.array_equal(one.wall_below, other.wall_below)
    )


class TestParsing:
    def test_reads_size_goals_and_walls(self):
        maze = parse_maze(SMALL)
        assert (maze.rows, maze.cols, maze.states) == (2, 3, 6)
        assert dict(maze.goals) == {"A": 0, "B": 5}
        assert maze.wall_below.tolist() == [[False, True, False]]
        assert maze.wall_right.tolist() == [[False, False], [False, True]]

    def test_orders_goals_by_letter_not_by_place(self):
        maze = parse_maze("+---+---+---+\n| C   .   A |\n+---+---+---+\n")
        assert maze.letters == ("A", "C")
        assert maze.goal_index("C") == 1

    def test_writes_back_the_same_text(self):
        assert format_maze(parse_maze(SMALL)) == SMALL

    def test_does_not_mind_the_line_ends_of_other_systems(self):
        assert same(parse_maze(SMALL.replace("\n", "\r\n")), parse_maze(SMALL))

    def test_reads_a_maze_of_one_cell(self):
        maze = parse_maze("+---+\n| A |\n+---+\n")
        assert maze.states == 1
        assert maze.successors.tolist() == [[0, 0, 0, 0, 0]]

    def test_goals_cannot_be_changed(self):
        with pytest.raises(TypeError):
            parse_maze(SMALL).goals["A"] = 3  # type: ignore[index]

    def test_can_be_sent_to_another_process(self):
        assert same(pickle.loads(pickle.dumps(parse_maze(SMALL))), parse_maze(SMALL))

    @given(st.integers(1, 8), st.integers(1, 8), st.integers(0, 10**6), st.floats(0, 1), st.data())
    def test_any_random_maze_survives_writing_and_reading(self, rows, cols, seed, openness, data):
        goals = data.draw(st.integers(1, min(26, rows * cols)))
        maze = random_maze(rows, cols, goals, np.random.default_rng(seed), openness)
        assert same(parse_maze(format_maze(maze)), maze)


class TestBlanks:
    @pytest.mark.parametrize(
        "text",
        [
            f"\n  \n{SMALL}\n\n \n",
            SMALL.replace("\n", "  \n"),
            SMALL.replace("\n", "\t\n"),
            "\r\n" + SMALL.replace("\n", " \r\n") + "\r\n",
            SMALL.replace("\n", " \n", 1).rstrip(),
        ],
        ids=["around", "at line ends", "tabs at line ends", "of other systems", "in line 1"],
    )
    def test_around_a_maze_and_at_line_ends_do_not_matter(self, text):
        assert same(parse_maze(text), parse_maze(SMALL))

    def test_before_a_maze_are_counted_in_the_lines_of_errors(self):
        assert message("\n \n" + put(4, 5, "!")).startswith("small.txt:6:5: expected '|'")
        assert message("\n\n" + put(3, 10, "---")).startswith("small.txt:6:11: expected a way")
        assert message("\n+---+\n").startswith("small.txt:3:1: expected an odd number of lines")
        assert message(f"\n{SMALL}".replace("B |", "B")).startswith("small.txt:5:12: ")

    @pytest.mark.parametrize("line", [1, 2, 3])
    def test_within_a_maze_matter(self, line):
        lines = SMALL.splitlines()
        lines.insert(line, "")
        assert message("\n".join(lines)).startswith("small.txt:")
        indented = "\n".join(f" {line}" for line in lines)
        assert message(indented).startswith("small.txt:")

    def test_a_tab_is_no_opening(self):
        said = message(put(2, 5, "\t"))
        assert said == "small.txt:2:5: expected '|' or ' ', found '\\t'"


class TestFaults:
    @pytest.mark.parametrize(
        ("line", "column", "sign", "expected"),
        [
            (1, 1, "x", "small.txt:1:1: expected '+', found 'x'"),
            (1, 6, "   ", "small.txt:1:6: expected '---', found '   '"),
            (3, 2, "--.", "small.txt:3:2: expected '---' or '   ', found '--.'"),
            (3, 5, " ", "small.txt:3:5: expected '+', found ' '"),
            (5, 13, "-", "small.txt:5:13: expected '+', found '-'"),
            (2, 1, " ", "small.txt:2:1: expected '|', found ' '"),
            (2, 13, " ", "small.txt:2:13: expected '|', found ' '"),
            (4, 5, "!", "small.txt:4:5: expected '|' or ' ', found '!'"),
            (2, 2, "-", "small.txt:2:2: expected ' ', found '-'"),
            (4, 4, "x", "small.txt:4:4: expected ' ', found 'x'"),
            (2, 7, "b", "small.txt:2:7: expected a cell: '.' or a capital letter, found 'b'"),
            (2, 7, "Ä", "small.txt:2:7: expected a cell: '.' or a capital letter, found 'Ä'"),
            (2, 7, " ", "small.txt:2:7: expected a cell: '.' or a capital letter, found ' '"),
            (4, 11, "A", "small.txt:4:11: expected a letter not used before, found 'A'"),
        ],
    )
    def test_a_wrong_sign_is_named_with_line_and_column(self, line, column, sign, expected):
        assert message(put(line, column, sign)) == expected

    def test_a_line_too_short_is_named_where_it_ends(self):
        ragged = SMALL.replace("| .   . | B |", "| .   . | B")
        wanted = "small.txt:4:12: expected 13 characters as in the first line, found 11"
        assert message(ragged) == wanted

    def test_a_line_too_long_is_named_where_it_should_end(self):
        ragged = SMALL.replace("| .   . | B |", "| .   . | B | x")
        wanted = "small.txt:4:14: expected 13 characters as in the first line, found 15"
        assert message(ragged) == wanted

    @pytest.mark.parametrize("kept", [0, 1, 2, 4])
    def test_a_missing_line_is_named_after_the_last(self, kept):
        text = "\n".join(SMALL.splitlines()[:kept])
        assert message(text).startswith(f"small.txt:{kept + 1}:1: expected an odd number of lines")

    @pytest.mark.parametrize("border", ["+", "+--", "+---", "+---+-"])
    def test_a_border_of_no_whole_cells_is_named_in_line_1(self, border):
        found = message("\n".join([border] * 3))
        assert found.startswith(f"small.txt:1:{len(border) + 1}: expected a border of '+---'")

    def test_a_goal_walled_in_is_named(self):
        cut = put(3, 10, "---")
        said = "small.txt:4:11: expected a way to goal B, found walls all around it"
        assert message(cut) == said
        alone = cut.replace("A", ".")
        assert message(alone) == said

    def test_a_goal_in_another_room_is_named(self):
        apart = SMALL.replace("| A   .   . |", "| A   . | . |")
        assert message(apart) == "small.txt:4:11: expected a way from goal B to A, found none"

    @pytest.mark.parametrize("text", ["", "\n", " \n\t\n"])
    def test_nothing_but_blanks_is_a_missing_maze(self, text):
        assert message(text).startswith("small.txt:1:1: expected an odd number of lines")

    def test_a_maze_without_goals_is_refused(self):
        assert "at least one goal" in message("+---+\n| . |\n+---+\n")

    def test_every_error_is_a_policy_error(self):
        assert issubclass(MazeError, PolicyError)

    def test_a_letter_that_is_no_goal_is_answered_with_those_that_are(self):
        with pytest.raises(MazeError, match=r"a goal of the maze \(A B\), came 'C'"):
            parse_maze(SMALL).goal_index("C")


class TestMoving:
    def test_moves_lead_to_neighbours_and_walls_stop_them(self):
        after = parse_maze(SMALL).successors
        assert after[0].tolist() == [0, 3, 0, 1, 0]
        assert after[1].tolist() == [1, 1, 0, 2, 1]
        assert after[4].tolist() == [4, 4, 3, 4, 4]

    @given(st.integers(0, 10**6))
    def test_every_way_leads_back(self, seed):
        after = random_maze(4, 5, 1, np.random.default_rng(seed)).successors
        back = [Action.DOWN, Action.UP, Action.RIGHT, Action.LEFT]
        for x in range(20):
            for a in range(4):
                assert after[x, a] == x or after[after[x, a], back[a]] == x


class TestRandomMazes:
    def test_the_same_seed_gives_the_same_maze(self, draw_maze):
        assert format_maze(draw_maze(9, 7, 4, seed=3)) == format_maze(draw_maze(9, 7, 4, seed=3))

    def test_other_seeds_give_other_mazes(self, draw_maze):
        assert len({format_maze(draw_maze(6, 6, 3, seed=s)) for s in range(20)}) == 20

    def test_without_openings_it_is_a_tree(self, draw_maze):
        maze = draw_maze(7, 9, 2, openness=0)
        assert len(maze.edges.data) / 2 == 63 - 1

    def test_openness_is_the_share_of_other_walls_removed(self, draw_maze):
        maze = draw_maze(10, 10, 2, openness=0.2)
        others = 180 - 99
        assert maze.wall_right.sum() + maze.wall_below.sum() == others - round(0.2 * others)

    def test_fully_open_has_no_walls(self, draw_maze):
        maze = draw_maze(5, 5, 2, openness=1)
        assert not maze.wall_right.any()
        assert not maze.wall_below.any()

    @pytest.mark.parametrize(
        ("rows", "cols", "goals", "openness", "said"),
        [
            (0, 3, 1, 0.2, "0 x 3 cells"),
            (3, 3, 0, 0.2, "0 goals"),
            (2, 2, 5, 0.2, "1 to 4 goals"),
            (9, 9, 27, 0.2, "1 to 26 goals"),
            (3, 3, 1, 1.5, "openness from 0 to 1, came 1.5"),
        ],
    )
    def test_impossible_mazes_are_refused(self, draw_maze, rows, cols, goals, openness, said):
        with pytest.raises(MazeError, match=said):
            draw_maze(rows, cols, goals, openness=openness)
