"""Maze files and folders of them, checked whole: every bad file is named, not only the first."""

from collections.abc import Callable, Iterable
from pathlib import Path

from policies.errors import MazeError
from policies.maze import Maze, parse_maze

Fault = Callable[[Maze], str | None]
"""What makes a maze unfit for an experiment, or None."""


def read_maze(path: Path) -> Maze:
    """Read a maze file; MazeError names file, line and column."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise MazeError(f"{path}: expected a readable file: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise MazeError(f"{path}: expected text in UTF-8: {error}") from error
    return parse_maze(text, source=str(path))


def read_maze_files(paths: Iterable[Path], fault: Fault = lambda _: None) -> dict[str, Maze]:
    """The mazes of files, by file name without the ending, in the order given.

    MazeError has a line for every file that cannot be read or whose maze has a fault.
    """
    mazes, faults = dict[str, Maze](), list[str]()
    for path in paths:
        try:
            maze = mazes[path.stem] = read_maze(path)
        except MazeError as error:
            faults.append(str(error))
        else:
            if unfit := fault(maze):
                faults.append(f"{path}: {unfit}")
    if faults:
        raise MazeError("\n".join(faults))
    return mazes


def read_mazes(folder: Path, fault: Fault = lambda _: None) -> dict[str, Maze]:
    """The mazes of a folder's `.txt` files as in `read_maze_files`, in order of names."""
    paths = sorted(folder.glob("*.txt"))
    if not paths:
        raise MazeError(f"{folder}: expected a folder with maze files (.txt), found none")
    return read_maze_files(paths, fault)
