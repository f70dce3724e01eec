"""A whole copy of a database, also of one in use, and what is odd about the files it comes from."""

import os
import shutil
import sqlite3
import struct
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from app.database_files import INDEX, LOG, beside, expect_database, files_of, make_private
from app.errors import DatabaseUnavailable
from app.sqlite import damage, in_turn, primary_code, read_only, refusals

Progress = Callable[[int, int], None]
"""Hears how many pages are copied, of how many."""

PAGES_AT_ONCE = 1000
_LOG_HEADER = struct.Struct(">8I")
_LOG_MAGIC = 0x377F0682
"""Its last bit says in which order of bytes the log's checksums are made."""


def copy_database(file: Path, to: Path, progress: Progress | None = None) -> None:
    """Write what a database holds at this moment into a new file, private, whole and checked.

    The database may be in use, read-only, or lie in a folder that is; nothing of it is changed.
    """
    expect_database(file)
    with refusals(file), _reading(file) as source:
        try:
            write_copy(source, to, progress)
        except sqlite3.OperationalError as error:
            if primary_code(error) != sqlite3.SQLITE_FULL:
                raise
            raise DatabaseUnavailable(f"{file}: its copy has no room on the disk") from error
    found = damage(to)
    if found:
        raise DatabaseUnavailable(f"{file}: it is damaged ({found})")


def write_copy(source: sqlite3.Connection, to: Path, progress: Progress | None = None) -> None:
    """Copy what a connection reads, at one moment, into a new file that needs no others."""
    make_private(to)
    with closing(sqlite3.connect(to, isolation_level=None)) as copy:
        # One moment, also for a database that is written to all the time.
        source.execute("BEGIN")
        try:
            in_turn(lambda: source.execute("SELECT 1 FROM sqlite_schema").fetchall())
            # It is brought to the disk below, once.
            copy.execute("PRAGMA synchronous=OFF")
            source.backup(
                copy,
                pages=PAGES_AT_ONCE,
                progress=progress and (lambda _, left, of: progress(of - left, of)),
                sleep=0,
            )
            copy.execute("PRAGMA journal_mode=DELETE").fetchall()
        finally:
            source.execute("ROLLBACK")
    with to.open("rb") as written:
        os.fsync(written.fileno())


@contextmanager
def _reading(file: Path) -> Iterator[sqlite3.Connection]:
    """A connection that reads a database and leaves nothing beside it.

    Where that is not possible, it reads a copy of the files: SQLite would put a log's index beside
    a file that nobody has open, and cannot in a folder that is read-only.
    """
    connection = _in_place(file)
    if connection:
        with closing(connection):
            yield connection
        return
    with TemporaryDirectory() as folder:
        for one in files_of(file):
            if one != beside(file, INDEX):
                shutil.copyfile(one, Path(folder) / one.name)
        with closing(sqlite3.connect(Path(folder) / file.name, isolation_level=None)) as connection:
            yield connection


def _in_place(file: Path) -> sqlite3.Connection | None:
    if _has_log(file) and not beside(file, INDEX).exists():
        return None
    connection = read_only(file)
    try:
        in_turn(lambda: connection.execute("SELECT 1 FROM sqlite_schema").fetchall())
    except sqlite3.Error as error:
        connection.close()
        if primary_code(error) in (sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_READONLY):
            return None
        raise
    return connection


def oddities(file: Path) -> list[str]:
    """What lets one doubt that the newest answers are in the files of a database, in sentences."""
    written = beside(file, LOG)
    if not written.exists():
        return [
            f"{file} has no log ({written.name}) beside it. If it was copied while the study ran, "
            "the newest answers are missing; goalguess backup makes a whole copy."
        ] * _has_log(file)
    with written.open("rb") as log, file.open("rb") as main:
        header, page_size = log.read(_LOG_HEADER.size), int.from_bytes(main.read(18)[16:], "big")
    if not header or _fits(header, page_size):
        return []
    return [
        f"{written} is not the log of {file.name}, or is damaged: SQLite leaves it out, and the "
        "newest answers may be missing."
    ]


def _has_log(file: Path) -> bool:
    """Whether a database is one whose newest answers are in a log beside it."""
    with file.open("rb") as main:
        return main.read(20)[18:] == b"\x02\x02"


def _fits(header: bytes, page_size: int) -> bool:
    """Whether this begins the log of a database with that page size, and is not damaged.

    Source: "The Checksum Algorithm" in https://www.sqlite.org/fileformat2.html#walformat
    """
    if len(header) < _LOG_HEADER.size:
        return False
    magic, _, log_page_size, *_, sum_1, sum_2 = _LOG_HEADER.unpack(header)
    # 65,536 does not fit into the two bytes of the main file, which says 1.
    if magic | 1 != _LOG_MAGIC | 1 or log_page_size != (65_536 if page_size == 1 else page_size):
        return False
    words = struct.unpack(">6I" if magic & 1 else "<6I", header[:24])
    first = second = 0
    for even, odd in zip(words[::2], words[1::2], strict=True):
        first = (first + even + second) & 0xFFFFFFFF
        second = (second + odd + first) & 0xFFFFFFFF
    return (first, second) == (sum_1, sum_2)
