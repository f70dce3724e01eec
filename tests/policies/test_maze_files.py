import pytest
from typer.testing import CliRunner

from policies import MazeError, commands, format_maze, parse_maze, read_maze, read_mazes
from policies.maze_files import read_maze_files

SMALL = "+---+---+---+\n| A   .   . |\n+---+---+---+\n"


def same(one, other) -> bool:
    return format_maze(one) == format_maze(other)


class TestFiles:
    def test_the_error_names_the_file(self, tmp_path):
        path = tmp_path / "broken.txt"
        path.write_text(SMALL.replace("A", "a"), encoding="utf-8")
        with pytest.raises(MazeError, match=r"broken\.txt:2:3: "):
            read_maze(path)

    def test_a_byte_order_mark_is_no_fault(self, tmp_path):
        path = tmp_path / "marked.txt"
        path.write_text(SMALL, encoding="utf-8-sig")
        assert same(read_maze(path), parse_maze(SMALL))

    def test_a_missing_file_is_a_maze_error(self, tmp_path):
        with pytest.raises(MazeError, match=r"none\.txt: expected a readable file"):
            read_maze(tmp_path / "none.txt")

    def test_bytes_that_are_no_text_are_a_maze_error(self, tmp_path):
        path = tmp_path / "bytes.txt"
        path.write_bytes(b"\xff\xfe\x00")
        with pytest.raises(MazeError, match="UTF-8"):
            read_maze(path)


@pytest.fixture
def bad_folder(tmp_path):
    """A folder of five mazes, of which only the second can be read."""
    folder = tmp_path / "bad"
    (folder / "4.txt").mkdir(parents=True)
    (folder / "1.txt").write_text("+---+---+\n| A   b |\n+---+---+\n", encoding="utf-8")
    (folder / "2.txt").write_text(SMALL, encoding="utf-8")
    (folder / "3.txt").write_bytes(b"\xff")
    (folder / "5.txt").write_text(SMALL.replace("A   .", "A | ."), encoding="utf-8")
    return folder


class TestFolders:
    def test_mazes_are_named_by_their_files_and_come_in_order_of_names(self, tmp_path, draw_maze):
        drawn = {name: draw_maze(3, 4, 2, seed=i) for i, name in enumerate("bac")}
        for name, maze in drawn.items():
            (tmp_path / f"{name}.txt").write_text(format_maze(maze), encoding="utf-8")
        (tmp_path / "notes.md").write_text("no maze", encoding="utf-8")
        read = read_mazes(tmp_path)
        assert list(read) == ["a", "b", "c"]
        assert all(same(read[name], drawn[name]) for name in read)

    @pytest.mark.parametrize("folder", [".", "missing"])
    def test_a_folder_without_mazes_is_refused(self, tmp_path, folder):
        with pytest.raises(MazeError, match=r"expected a folder with maze files \(\.txt\)"):
            read_mazes(tmp_path / folder)

    def test_every_bad_file_is_named_in_a_line_of_its_own(self, bad_folder):
        with pytest.raises(MazeError) as caught:
            read_mazes(bad_folder)
        lines = str(caught.value).splitlines()
        assert [line.removeprefix(f"{bad_folder}/") for line in lines] == [
            "1.txt:2:7: expected a cell: '.' or a capital letter, found 'b'",
            "3.txt: expected text in UTF-8: 'utf-8' codec can't decode byte 0xff in position 0: "
            "invalid start byte",
            "4.txt: expected a readable file: Is a directory",
            "5.txt:2:3: expected a way to goal A, found walls all around it",
        ]

    def test_so_is_every_maze_that_is_unfit_for_what_is_asked(self, bad_folder):
        with pytest.raises(MazeError) as caught:
            read_mazes(bad_folder, lambda maze: "too few" if maze.states < 4 else None)
        lines = str(caught.value).splitlines()
        assert len(lines) == 5
        assert lines[1] == f"{bad_folder / '2.txt'}: too few"

    def test_a_missing_file_among_those_asked_for_is_named_too(self, bad_folder):
        with pytest.raises(MazeError, match=r"none\.txt: expected a readable file.*\n.*1\.txt:2:7"):
            read_maze_files(bad_folder / name for name in ("none.txt", "2.txt", "1.txt"))

    @pytest.mark.parametrize("command", ["compare states", "teach samples"])
    def test_commands_name_them_in_a_line_each_and_leave_nothing(
        self, bad_folder, tmp_path, command
    ):
        out = tmp_path / "out"
        given = [*command.split(), "--mazes", str(bad_folder), "--out", str(out)]
        result = CliRunner().invoke(commands, given)
        assert result.exit_code == 2
        lines = result.stderr.splitlines()
        # One goal in a row of three can be played for, but there is nothing to be guessed.
        assert len(lines) == (5 if "teach" in command else 4)
        assert all(line.startswith(f"goalguess: {bad_folder}/") for line in lines)
        assert not out.exists()
