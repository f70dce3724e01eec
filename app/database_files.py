"""The files of a database: the main one and those that SQLite keeps beside it, and whose they are.

In use, the newest answers are in the log (-wal) until they are carried over into the main file;
-shm is the log's index. A -journal is what an interrupted change of the schema is undone from.
"""

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TextIO

from app.errors import DatabaseMismatch, DatabaseUnavailable

LOG, INDEX, JOURNAL = "-wal", "-shm", "-journal"
RESCUED = "rescued"
"""In the name of a copy of what was in a database that was lost under a server."""
_Identity = tuple[int, int] | None


def beside(file: Path, suffix: str) -> Path:
    """The name of a file beside a database; SQLite has its own beside what a link leads to."""
    real = file.resolve() if file.is_symlink() else file
    return real.with_name(f"{real.name}{suffix}")


def files_of(file: Path) -> Iterator[Path]:
    """Those files of a database that exist, the main one first."""
    everything = (file, *(beside(file, suffix) for suffix in (LOG, INDEX, JOURNAL)))
    yield from (one for one in everything if one.exists())


def expect_database(file: Path, named_by: str = "") -> None:
    """DatabaseMismatch if there is no file to read answers from."""
    found = "a folder" if file.is_dir() else None if file.exists() else "no such file"
    if found:
        hint = f"; {named_by} names it" if named_by else ""
        raise DatabaseMismatch(f"{file}: expected a database with answers, found {found}{hint}")


def expect_folder(file: Path) -> None:
    """DatabaseMismatch if the folder in which a file is to be made does not exist."""
    if not file.parent.is_dir():
        raise DatabaseMismatch(f"{file}: expected a file in a folder that exists")


def make_private(file: Path) -> None:
    """Make a file that only its owner may read, unless it is there; SQLite's others follow it.

    An existing file is not even opened: closing it would end the locks of who has it open.
    """
    expect_folder(file)
    if file.is_dir():
        raise DatabaseMismatch(f"{file}: expected a SQLite database, found a folder")
    if not file.exists():
        with _making(file):
            os.close(os.open(file, os.O_CREAT | os.O_WRONLY, 0o600))


@contextmanager
def place_beside(file: Path) -> Iterator[Path]:
    """A private name in the same folder, to make a file under; what is left there goes away."""
    expect_folder(file)
    with _making(file):
        folder = TemporaryDirectory(prefix=f".{file.name}-", dir=file.parent)
    with folder as place:
        yield Path(place) / file.name


@contextmanager
def _making(file: Path) -> Iterator[None]:
    try:
        yield
    except PermissionError as error:
        raise DatabaseUnavailable(f"{file}: this user may not make files in its folder") from error


def append_privately(file: Path) -> TextIO:
    """Open a text file to append to, made so that only its owner may read it."""
    handle = os.open(file, os.O_CREAT | os.O_WRONLY | os.O_APPEND, 0o600)
    return os.fdopen(handle, "a", encoding="ascii")


def open_to_others(files: Iterable[Path]) -> list[Path]:
    """Those of the files that other users of this machine may read or write."""
    return [file for file in files if file.exists() and file.stat().st_mode & 0o077]


def dated(file: Path, word: str) -> Path:
    """A name beside a file that says what happened to it, and when."""
    return beside(file, f".{word}-{datetime.now(UTC):%Y%m%dT%H%M%SZ}")


def sync_folder(folder: Path) -> None:
    """Bring the names in a folder to the disk."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


class FilesInUse:
    """The files a database was found to be when it was opened, to see whether they still are."""

    def __init__(self, file: Path) -> None:
        self._known = {one: identity(one) for one in (file, beside(file, LOG), beside(file, INDEX))}
        self._file, self._size = file, 0

    def trouble(self) -> str | None:
        """What happened to the first of them that is not the same any more, if any."""
        for file, known in self._known.items():
            now = identity(file)
            if now != known:
                return f"{file} was {'removed or moved' if now is None else 'replaced'}"
        # No answer makes the main file shorter, nor does a withdrawal.
        size = self._file.stat().st_size if self._file.exists() else 0
        if size < self._size:
            return f"{self._file} was overwritten"
        self._size = size
        return None


def identity(file: Path) -> _Identity:
    """Which file a path leads to, if any: its device and number there."""
    try:
        found = file.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino
