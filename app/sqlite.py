"""SQLite as this study uses it: its engine, taking turns with other processes, its errors.

Whatever the database cannot do just now becomes DatabaseUnavailable, one line without SQL; what
is no SQLite database becomes DatabaseMismatch; any other error of the driver is a bug of ours and
stays what it is.
"""

import sqlite3
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from functools import partial
from pathlib import Path
from typing import Any

from sqlalchemy import URL, Connection, Engine, create_engine, event, make_url
from sqlalchemy.exc import DBAPIError
from sqlalchemy.pool import NullPool

from app.database_files import JOURNAL, beside
from app.errors import AppError, DatabaseMismatch, DatabaseUnavailable

BUSY_MS = 10_000
"""How long to wait for another process that is writing."""
ASK_AGAIN_MS = 10
"""How long SQLite waits by itself when we begin to write, before we ask it again."""

LOCKED = "another program is writing to it, or has it locked"
_UNAVAILABLE = {
    sqlite3.SQLITE_BUSY: LOCKED,
    sqlite3.SQLITE_LOCKED: LOCKED,
    sqlite3.SQLITE_READONLY: "it can be read, but not written to",
    sqlite3.SQLITE_PERM: "this user may not read or write it, or a file beside it",
    sqlite3.SQLITE_CANTOPEN: "this user may not read or write it, or a file beside it",
    sqlite3.SQLITE_IOERR: "its disk reports an error",
    sqlite3.SQLITE_FULL: "its disk is full",
    sqlite3.SQLITE_CORRUPT: "it is damaged",
}
"""What an error's primary code means to who runs the study."""


def sqlite_engine(url: str | URL, begin: str) -> Engine:
    """An engine whose transactions start with `begin`, durable and with foreign keys enforced."""
    engine = create_engine(url, poolclass=NullPool, hide_parameters=True)
    busy_ms = ASK_AGAIN_MS if begin == "BEGIN IMMEDIATE" else BUSY_MS

    @event.listens_for(engine, "connect")
    def configure(connection: Any, _record: Any) -> None:
        # The driver must not begin transactions of its own: they are begun below, explicitly.
        connection.isolation_level = None
        for pragma in (
            f"busy_timeout={busy_ms}",
            "synchronous=FULL",
            "foreign_keys=ON",
            "secure_delete=ON",
        ):
            # Some read the schema, for which a locked file is waited too.
            in_turn(partial(connection.execute, f"PRAGMA {pragma}"))

    @event.listens_for(engine, "begin")
    def begin_explicitly(connection: Connection) -> None:
        in_turn(lambda: connection.exec_driver_sql(begin))

    return engine


def file_of(url: str | URL) -> Path:
    """The file that the address of a SQLite database names."""
    return Path(str(make_url(url).database))


def url_of(file: Path) -> URL:
    """The address of the SQLite database in a file."""
    return URL.create("sqlite", database=str(file))


def in_turn(begin: Callable[[], object]) -> None:
    """Begin as soon as no other process is writing, within BUSY_MS.

    SQLite's own waiting asks ever less often and so starves beside a process that writes without
    a pause; before it changes to WAL it does not wait at all.
    """
    give_up = time.monotonic() + BUSY_MS / 1000
    while True:
        try:
            begin()
            return
        except Exception as error:
            if primary_code(error) != sqlite3.SQLITE_BUSY or time.monotonic() > give_up:
                raise
            time.sleep(0.001)


def run_pragma(engine: Engine, pragma: str) -> None:
    """Run a PRAGMA that is not possible within a transaction."""
    connection = engine.raw_connection()
    try:
        connection.cursor().execute(f"PRAGMA {pragma}").fetchall()
    finally:
        connection.close()


def read_only(file: Path) -> sqlite3.Connection:
    """A connection that changes nothing in the file, not even when it closes as the last one."""
    address = f"{file.absolute().as_uri()}?mode=ro"
    return sqlite3.connect(address, uri=True, isolation_level=None, timeout=BUSY_MS / 1000)


def damage(file: Path) -> str | None:
    """What SQLite finds wrong with the structure of a database, if anything.

    Read-only where possible: a log that does not belong to the file must not be written into it.
    """
    torn = beside(file, JOURNAL).exists()
    with refusals(file), closing(sqlite3.connect(file) if torn else read_only(file)) as connection:
        try:
            (found,) = connection.execute("PRAGMA quick_check(1)").fetchone()
        except sqlite3.DatabaseError as error:
            if primary_code(error) != sqlite3.SQLITE_CORRUPT:
                raise
            return str(error)
    said = " ".join(str(found).split()).removeprefix("*** in database main *** ")
    return None if said == "ok" else said


@contextmanager
def refusals(file: Path | str) -> Iterator[None]:
    """Name the file and the reason, in one line, where SQLite cannot do what it is asked to."""
    try:
        yield
    except (DBAPIError, sqlite3.Error) as error:
        refusal = refusal_of(error, file)
        if refusal is None:
            raise
        raise refusal from error


def refusal_of(error: BaseException, file: Path | str) -> AppError | None:
    """What an error of SQLite is to who runs the study; None for a bug of ours."""
    code = primary_code(error)
    if code == sqlite3.SQLITE_NOTADB:
        return DatabaseMismatch(f"{file}: expected a SQLite database, found something else")
    reason = _UNAVAILABLE.get(code)
    return DatabaseUnavailable(f"{file}: {reason}") if reason else None


def primary_code(error: BaseException) -> int:
    """SQLite's number for what happened, of an error of the driver or of SQLAlchemy."""
    cause = getattr(error, "orig", error)
    code: int = getattr(cause, "sqlite_errorcode", sqlite3.SQLITE_OK)
    # The lowest byte says what happened, the next one where.
    return code & 0xFF
