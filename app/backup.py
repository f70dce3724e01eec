"""Backup, restore, and the private snapshot that exports read: whole copies of a database.

None of them changes a byte of what it is made from, which may be in use or read-only.
"""

import fcntl
import os
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from app.copying import Progress, copy_database
from app.database import Database
from app.database_files import beside, dated, files_of, place_beside, sync_folder
from app.enrolment import withdraw_again
from app.errors import AppError, DatabaseUnavailable, InvalidInput
from app.opening import expect_pool, holdings
from app.schema import expect_ours, prepare
from app.sqlite import sqlite_engine, url_of
from app.study import Study

SHARED_LOCK = 0x4000_0002, 510
"""First byte and number of those that SQLite locks while it has a file open, in os_unix.c."""


@dataclass(frozen=True)
class Restored:
    """What a restored database holds, how many it dropped, where what it replaced was kept.

    `replaced_holds` is None where that cannot be read.
    """

    holds: str
    dropped: int
    replaced: Path | None
    replaced_holds: str | None


def back_up(file: Path, to: Path, progress: Progress) -> str:
    """Write a database, also one in use, to a new file; returns what it holds, in words."""
    if to.exists() or to.is_symlink():
        raise InvalidInput(f"{to}: expected the name of a new file, found one that is there")
    with place_beside(to) as copy:
        copy_database(file, copy, progress)
        expect_ours(copy, str(file))
        holds = _holdings_of(copy)
        copy.rename(to)
        sync_folder(to.parent)
    return holds


def restore(study: Study, backup: Path, progress: Progress) -> Restored:
    """Put a backup in the place of the study's database, without who withdrew since.

    DatabaseUnavailable while another process has the database open. Whatever fails, fails before
    anything is changed; what was there is kept under another name.
    """
    file = study.settings.database_file
    if file.is_symlink():
        file = file.resolve()
    if file.exists() and backup.exists() and file.samefile(backup):
        raise InvalidInput(f"{backup}: expected a backup, found the study's database itself")
    # Before it is locked: SQLite, closing a file, would end this process's lock on it.
    replaced_holds = _holdings_now(file)
    with _nobody_else_in(file), place_beside(file) as copy:
        dropped = _copy_without_withdrawn(study, backup, copy, progress)
        return Restored(_holdings_of(copy), dropped, _exchange(file, copy), replaced_holds)


@contextmanager
def snapshot(study: Study, progress: Progress | None = None) -> Iterator[Database]:
    """The study's database as it is at this moment, up to date, without who withdrew."""
    file = study.settings.database_file
    with TemporaryDirectory() as folder:
        copy = Path(folder) / file.name
        _copy_without_withdrawn(study, file, copy, progress)
        with closing(Database(url_of(copy))) as database:
            database.read_now(lambda connection: expect_pool(connection, study))
            yield database


def _holdings_of(copy: Path) -> str:
    with sqlite_engine(url_of(copy), "BEGIN").connect() as connection, connection.begin():
        return holdings(connection)


def _holdings_now(file: Path) -> str | None:
    """What a database that may be damaged, or none of ours, holds; None if it cannot be read."""
    with TemporaryDirectory() as folder:
        copy = Path(folder) / file.name
        try:
            copy_database(file, copy)
            expect_ours(copy, str(file))
            return _holdings_of(copy)
        except (AppError, OSError):
            return None


def _copy_without_withdrawn(study: Study, file: Path, copy: Path, progress: Progress | None) -> int:
    """Copy a database of any version as one of this version; how many had withdrawn since."""
    copy_database(file, copy, progress)
    expect_ours(copy, str(file))
    prepare(url_of(copy), str(file))
    engine = sqlite_engine(url_of(copy), "BEGIN IMMEDIATE")
    with engine.connect() as connection, connection.begin():
        return withdraw_again(connection, study)


@contextmanager
def _nobody_else_in(file: Path) -> Iterator[None]:
    """Keep all other processes out of a database; DatabaseUnavailable if one is in.

    By the lock that SQLite itself holds, as a damaged file cannot be opened with SQLite.
    """
    if not file.exists():
        yield
        return
    handle = os.open(file, os.O_RDWR)
    try:
        begin, length = SHARED_LOCK
        fcntl.lockf(handle, fcntl.LOCK_EX | fcntl.LOCK_NB, length, begin)
    except (BlockingIOError, PermissionError):
        os.close(handle)
        raise DatabaseUnavailable(
            f"{file}: another process has it open; stop the server, then restore"
        ) from None
    try:
        yield
    finally:
        os.close(handle)


def _exchange(file: Path, copy: Path) -> Path | None:
    """Put a copy in a database's place; returns the new name of what was there, if anything.

    The old files have their new names before they lose the old ones, and the log goes before its
    database does: SQLite would take it for the new one's.
    """
    replaced = dated(file, "replaced")
    old = list(files_of(file))
    kept: list[Path] = []
    try:
        for one in old:
            new = beside(replaced, one.name.removeprefix(file.name))
            new.hardlink_to(one)
            kept.append(new)
            new.chmod(0o600)
    except OSError:
        for new in kept:
            new.unlink()
        raise
    sync_folder(file.parent)
    for one in old:
        if one != file:
            one.unlink()
    copy.replace(file)
    sync_folder(file.parent)
    return replaced if old else None
