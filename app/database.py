"""The database: `read(fn)` and `write(fn)`, one writer, group commit.

All writes queue to one thread that runs the waiting functions in one transaction, each behind a
savepoint of its own, commits once, and only then answers them all: acknowledged means on disk,
two writes never race, and a slow disk costs latency, not throughput.
"""

import asyncio
import sqlite3
import time
from collections.abc import Callable
from concurrent.futures import Future
from queue import Empty, SimpleQueue
from threading import Lock, Thread
from typing import Any, NamedTuple, TypeVar

from sqlalchemy import Connection, Engine, create_engine, event
from sqlalchemy.pool import NullPool

T = TypeVar("T")
Work = Callable[[Connection], T]

LARGEST_GROUP = 200
BUSY_MS = 10_000
"""How long to wait for another process that is writing."""
ASK_AGAIN_MS = 10
"""How long SQLite waits by itself when we begin to write, before we ask it again."""


class _Waiting(NamedTuple):
    work: Work[Any]
    done: Future[Any]


class Database:
    """A SQLite file in use; `close()` ends the writer after what is queued."""

    def __init__(self, url: str) -> None:
        self._write_engine = sqlite_engine(url, begin="BEGIN IMMEDIATE")
        # Lets readers go on while the writer writes; the file remembers it.
        _in_turn(lambda: run_pragma(self._write_engine, "journal_mode=WAL"))
        self._read_engine = sqlite_engine(url, begin="BEGIN")
        self._reader = self._read_engine.connect()
        self._reading = Lock()
        self._queue: SimpleQueue[_Waiting | None] = SimpleQueue()
        self._writer = Thread(target=self._run_writer, name="database-writer", daemon=True)
        self._writer.start()

    def read_now(self, work: Work[T]) -> T:
        """Run a function that only reads, on a snapshot, and return what it returns."""
        with self._reading, self._reader.begin():
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

    def forget_deleted(self) -> None:
        """Empty the write-ahead log, which still holds what was deleted from the database."""
        run_pragma(self._read_engine, "wal_checkpoint(TRUNCATE)")

    def close(self) -> None:
        """Finish the queued writes and let go of the file."""
        self._queue.put(None)
        self._writer.join()
        self._reader.close()
        self._read_engine.dispose()
        self._write_engine.dispose()

    def _run_writer(self) -> None:
        with self._write_engine.connect() as connection:
            open_for_work = True
            while open_for_work:
                group = self._next_group()
                open_for_work = group[-1] is not None
                _commit_together(connection, [waiting for waiting in group if waiting])

    def _next_group(self) -> list[_Waiting | None]:
        """Wait for a write, then take whatever else is waiting; ends with None on close."""
        group = [self._queue.get()]
        while group[-1] is not None and len(group) < LARGEST_GROUP:
            try:
                group.append(self._queue.get_nowait())
            except Empty:
                break
        return group


def _commit_together(connection: Connection, group: list[_Waiting]) -> None:
    """Run a group in one transaction; a failing function is undone alone."""
    if not group:
        return
    outcomes: list[tuple[Future[Any], Any, BaseException | None]] = []
    try:
        with connection.begin():
            for work, done in group:
                # From here on nobody can cancel it; whoever gave up before is left out.
                if not done.set_running_or_notify_cancel():
                    continue
                connection.exec_driver_sql("SAVEPOINT before_work")
                try:
                    outcomes.append((done, work(connection), None))
                except Exception as failure:
                    connection.exec_driver_sql("ROLLBACK TO before_work")
                    outcomes.append((done, None, failure))
                connection.exec_driver_sql("RELEASE before_work")
    except BaseException as failure:
        # SQLite keeps a transaction open whose COMMIT failed; SQLAlchemy takes it for ended.
        connection.connection.rollback()
        outcomes = [(done, None, failure) for _, done in group if not done.cancelled()]
    for done, result, error in outcomes:
        if error is None:
            done.set_result(result)
        else:
            done.set_exception(error)


def sqlite_engine(url: str, begin: str) -> Engine:
    """An engine whose transactions start with `begin`, durable and with foreign keys enforced."""
    # Without hide_parameters an error would tell the log who it was about.
    engine = create_engine(url, poolclass=NullPool, hide_parameters=True)
    busy_ms = ASK_AGAIN_MS if begin == "BEGIN IMMEDIATE" else BUSY_MS

    @event.listens_for(engine, "connect")
    def configure(connection: Any, _record: Any) -> None:
        # The driver must not begin transactions of its own: they are begun below, explicitly.
        connection.isolation_level = None
        for pragma in (
            "synchronous=FULL",
            "foreign_keys=ON",
            "secure_delete=ON",
            f"busy_timeout={busy_ms}",
        ):
            connection.execute(f"PRAGMA {pragma}")

    @event.listens_for(engine, "begin")
    def begin_explicitly(connection: Connection) -> None:
        _in_turn(lambda: connection.exec_driver_sql(begin))

    return engine


def _in_turn(begin: Callable[[], object]) -> None:
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
            if not _is_busy(error) or time.monotonic() > give_up:
                raise
            time.sleep(0.001)


def _is_busy(error: Exception) -> bool:
    cause = getattr(error, "orig", error)
    code = getattr(cause, "sqlite_errorcode", sqlite3.SQLITE_OK)
    # The lowest byte says what happened, the next one where.
    return code & 0xFF == sqlite3.SQLITE_BUSY


def run_pragma(engine: Engine, pragma: str) -> None:
    """Run a PRAGMA that is not possible within a transaction."""
    connection = engine.raw_connection()
    try:
        connection.cursor().execute(f"PRAGMA {pragma}").fetchall()
    finally:
        connection.close()
