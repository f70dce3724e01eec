"""The database: `read(fn)` and `write(fn)`, one writer, group commit.

All writes queue to one thread that runs the waiting functions in one transaction, each behind a
savepoint of its own, commits once, and only then answers them all: acknowledged means on disk,
two writes never race, and a slow disk costs latency, not throughput.

The thread also sees after each commit whether the files are still where they were opened. If not,
nothing is acknowledged or read any more, and what was acknowledged is copied to a file beside.
"""

import asyncio
import ctypes
import logging
import sqlite3
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from queue import Empty, SimpleQueue
from threading import Lock, Thread
from typing import Any, NamedTuple, TypeVar

from sqlalchemy import URL, Connection, Engine

from app.copying import write_copy
from app.database_files import LOG, RESCUED, FilesInUse, beside, dated, identity, make_private
from app.errors import AppError, DatabaseUnavailable
from app.sqlite import damage, file_of, in_turn, refusal_of, refusals, run_pragma, sqlite_engine

T = TypeVar("T")
Work = Callable[[Connection], T]

LARGEST_GROUP = 200
CONNECT_AGAIN = 20
"""Tries to have a log; some file systems allow none."""
EMPTY_AGAIN_S = 0.1
"""Pause between two tries to empty the log."""
FORGET_WITHIN_S = 0.5
"""How long a reply waits for the log to be emptied."""

log = logging.getLogger("goalguess")


class _Waiting(NamedTuple):
    work: Work[Any]
    done: Future[Any]


class Database:
    """A SQLite file in use; `close()` ends the writer after what is queued."""

    def __init__(self, url: str | URL) -> None:
        self._file = file_of(url)
        make_private(self._file)
        opened = identity(self._file)
        writing, reading = sqlite_engine(url, "BEGIN IMMEDIATE"), sqlite_engine(url, "BEGIN")
        with refusals(self._file):
            self._writer, self._reader = _connect(writing, reading)
            for _ in range(CONNECT_AGAIN):
                if beside(self._file, LOG).exists():
                    break
                # Another process closed the file, and with it the log, in this very moment.
                self._writer.close()
                self._reader.close()
                self._writer, self._reader = _connect(writing, reading)
        self._in_use = FilesInUse(self._file)
        if identity(self._file) != opened:
            raise DatabaseUnavailable(f"{self._file}: it was exchanged while it was opened")
        self._lost: str | None = None
        # What a killed server had deleted may still be in its log.
        self._to_empty: list[Future[None]] = [Future()]
        self._reading = Lock()
        self._queue: SimpleQueue[_Waiting | None] = SimpleQueue()
        self._thread = Thread(target=self._run, name="database-writer", daemon=True)
        self._thread.start()

    def read_now(self, work: Work[T]) -> T:
        """Run a function that only reads, on a snapshot, and return what it returns."""
        with self._reading, refusals(self._file):
            if self._lost:
                raise DatabaseUnavailable(self._lost)
            with self._reader.begin():
                return work(self._reader)

    def submit(self, work: Work[T]) -> "Future[T]":
        """Queue a function that writes; the future is done when its transaction is on disk."""
        done: Future[T] = Future()
        self._queue.put(_Waiting(work, done))
        return done

    async def read(self, work: Work[T]) -> T:
        """Read in place: a look-up takes less time than handing it to a thread."""
        return self.read_now(work)

    async def write(self, work: Work[T]) -> T:
        """Return what the function returned, once its transaction is on disk."""
        return await asyncio.wrap_future(self.submit(work))

    async def forget_deleted(self) -> bool:
        """Have the log emptied, which still holds what was deleted from the database.

        Waits for it a moment; returns whether it is done. Whoever reads an older state of the
        database hinders it; it is then tried again until it is done, by the next start at the
        latest.
        """
        emptied: Future[None] = Future()
        self.submit(lambda _connection: self._to_empty.append(emptied))
        done, _ = await asyncio.wait([asyncio.wrap_future(emptied)], timeout=FORGET_WITHIN_S)
        return bool(done)

    def close(self) -> None:
        """Finish the queued writes and let go of the file."""
        self._queue.put(None)
        self._thread.join()
        if self._lost:
            _leave_open(self._writer)
            _leave_open(self._reader)
            return
        self._writer.close()
        # Without a log in use, one that is missing beside a copy can be noticed. While somebody
        # else has the database open, the file goes on having one.
        with self._reader, suppress(sqlite3.Error):
            self._reader.connection.cursor().execute("PRAGMA journal_mode=DELETE")

    def _run(self) -> None:
        open_for_work = True
        while open_for_work:
            group = self._next_group()
            open_for_work = None not in group
            self._commit_together([waiting for waiting in group if waiting])
            if self._to_empty and not self._lost:
                self._empty_log()
        with suppress(DatabaseUnavailable):
            self._expect_files()

    def _next_group(self) -> list[_Waiting | None]:
        """Wait for a write, then take whatever else is waiting; ends with None on close."""
        group: list[_Waiting | None] = []
        pause = EMPTY_AGAIN_S if self._to_empty and not self._lost else None
        try:
            group.append(self._queue.get(timeout=pause))
            while group[-1] is not None and len(group) < LARGEST_GROUP:
                group.append(self._queue.get_nowait())
        except Empty:
            pass
        return group

    def _commit_together(self, group: list[_Waiting]) -> None:
        """Run a group in one transaction; a failing function is undone alone."""
        # From here on nobody can cancel them; whoever gave up before is left out.
        group = [waiting for waiting in group if waiting.done.set_running_or_notify_cancel()]
        if not group:
            return
        try:
            if self._lost:
                raise DatabaseUnavailable(self._lost)
            with self._writer.begin():
                outcomes = [_run_alone(self._writer, waiting.work) for waiting in group]
            self._expect_files()
        except BaseException as failure:
            # SQLite keeps a transaction open whose COMMIT failed; SQLAlchemy takes it for ended.
            with suppress(sqlite3.Error):
                self._writer.connection.rollback()
            outcomes = [(None, failure)] * len(group)
        for (_, done), (result, error) in zip(group, outcomes, strict=True):
            if error is None:
                done.set_result(result)
            else:
                done.set_exception(refusal_of(error, self._file) or error)

    def _expect_files(self) -> None:
        """DatabaseUnavailable, now and ever after, if the files are not those that were opened."""
        trouble = None if self._lost else self._in_use.trouble()
        if trouble is None:
            return
        found = f"{trouble} while the study ran: nothing is stored or read any more"
        self._lost = f"{found}. {self._rescue()}"
        log.critical("%s", self._lost)
        raise DatabaseUnavailable(self._lost)

    def _rescue(self) -> str:
        """Copy what is in the lost files, which we still have open; says what to do with it."""
        copy = dated(self._file.absolute(), RESCUED)
        try:
            write_copy(_driver(self._writer), copy)
        except (AppError, OSError, sqlite3.Error) as error:
            copy.unlink(missing_ok=True)
            reason = refusal_of(error, copy) or error
            return f"Put the files back and start again; no copy could be made ({reason})."
        if found := damage(copy):
            return (
                f"What could still be copied is in {copy}, but damaged ({found}): put the files "
                "back, or restore your last backup, and start again."
            )
        return (
            f"All that was acknowledged is in {copy}: stop the server, run goalguess restore "
            f"{copy}, and start it again. Pages keep what is answered until then."
        )

    def _empty_log(self) -> None:
        """Carry the log over into the file and cut it to nothing, if no reader needs it."""
        with suppress(sqlite3.Error):
            cursor = self._writer.connection.cursor()
            busy, *_ = cursor.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()
            if not busy:
                while self._to_empty:
                    self._to_empty.pop().set_result(None)


def _connect(writing: Engine, reading: Engine) -> tuple[Connection, Connection]:
    """A writer and a reader that have the file open together with its log."""
    # Lets readers go on while the writer writes; the file remembers it.
    in_turn(lambda: run_pragma(writing, "journal_mode=WAL"))
    writer, reader = writing.connect(), reading.connect()
    with reader.begin():
        # From the first read on nobody else removes the log.
        reader.exec_driver_sql("SELECT 1 FROM sqlite_schema")
    return writer, reader


def _run_alone(connection: Connection, work: Work[Any]) -> tuple[Any, BaseException | None]:
    """Run a function behind a savepoint: what it returned, or undone, what it raised."""
    connection.exec_driver_sql("SAVEPOINT before_work")
    outcome: tuple[Any, BaseException | None]
    try:
        outcome = work(connection), None
    except Exception as failure:
        if not _driver(connection).in_transaction:
            # A disk that is full or fails may end the whole transaction.
            raise
        connection.exec_driver_sql("ROLLBACK TO before_work")
        outcome = None, failure
    connection.exec_driver_sql("RELEASE before_work")
    return outcome


def _driver(connection: Connection) -> sqlite3.Connection:
    driver: sqlite3.Connection = connection.connection.dbapi_connection  # type: ignore[assignment]
    return driver


def _leave_open(connection: Connection) -> None:
    """Keep a connection until the process ends: SQLite, closing, deletes the log by its name.

    Under that name there may be the log of another database by now.
    """
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(connection))
