"""read(fn), write(fn): durable, in one writer, each function alone to blame for its failure."""

import asyncio
import sqlite3
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import closing
from threading import Event, Semaphore

import pytest
from sqlalchemy import event, insert, select, text
from sqlalchemy.exc import IntegrityError

from app.database import Database
from app.sqlite import sqlite_engine
from app.tables import sessions, tallies


@pytest.fixture
def bare(settings):
    database = Database(settings.database_url)
    yield database
    database.close()


def add(name):
    return lambda connection: connection.execute(insert(tallies).values(name=name, count=1))


def names(database):
    return database.read_now(
        lambda connection: set(connection.scalars(select(tallies.c.name)).all())
    )


def hold(database):
    """Keep the writer busy until the returned event is set, so that what follows is one group."""
    begun, go_on = Event(), Event()

    def work(_connection):
        begun.set()
        go_on.wait(10)

    database.submit(work)
    assert begun.wait(10)
    return go_on


def test_a_write_returns_what_its_function_returned(bare):
    assert asyncio.run(bare.write(lambda _connection: 41 + 1)) == 42


def test_a_finished_write_is_seen_by_another_connection(bare, settings):
    bare.submit(add("one")).result()
    with sqlite_engine(settings.database_url, "BEGIN").connect() as other:
        assert other.scalar(select(tallies.c.count)) == 1


def test_a_write_is_not_acknowledged_before_its_commit(bare):
    committed = []
    event.listen(bare._writer, "commit", lambda _connection: committed.append(True))
    future = bare.submit(add("one"))
    seen = []
    future.add_done_callback(lambda _future: seen.append(list(committed)))
    future.result()
    assert seen in ([[True]], [])
    bare.submit(lambda _connection: None).result()
    assert seen == [[True]]


def test_waiting_writes_share_one_commit(bare):
    commits = []
    event.listen(bare._writer, "commit", lambda _connection: commits.append(1))
    go_on = hold(bare)
    waiting = [bare.submit(add(f"n{i}")) for i in range(50)]
    go_on.set()
    wait(waiting)
    assert len(names(bare)) == 50
    assert len(commits) == 2


def test_a_failing_function_harms_nobody_else_in_its_group(bare):
    def add_and_fail(connection):
        add("lost")(connection)
        raise ValueError("mine")

    go_on = hold(bare)
    before, failing, after = bare.submit(add("a")), bare.submit(add_and_fail), bare.submit(add("b"))
    go_on.set()
    before.result()
    after.result()
    with pytest.raises(ValueError, match="mine"):
        failing.result()
    assert names(bare) == {"a", "b"}


def test_a_failing_commit_acknowledges_nothing(bare):
    def break_a_promise(connection):
        connection.exec_driver_sql("PRAGMA defer_foreign_keys=ON")
        add("lost")(connection)
        orphan = {"token_hash": "x", "participant_id": 99, "current": True}
        connection.execute(
            text("INSERT INTO sessions VALUES (:token_hash, :participant_id, :current, '2026', 1)"),
            orphan,
        )

    go_on = hold(bare)
    innocent, failing = bare.submit(add("a")), bare.submit(break_a_promise)
    go_on.set()
    for future in (innocent, failing):
        with pytest.raises(IntegrityError):
            future.result()
    assert names(bare) == set()
    bare.submit(add("later")).result()
    assert names(bare) == {"later"}


def test_foreign_keys_are_enforced(bare):
    orphan = bare.submit(
        lambda connection: connection.execute(
            insert(sessions).values(token_hash="x", participant_id=99, current=True, began_at=None)
        )
    )
    with pytest.raises(IntegrityError):
        orphan.result()


def test_commits_are_synced_in_full_and_readers_do_not_wait(bare):
    pragmas = bare.submit(
        lambda connection: (
            connection.exec_driver_sql("PRAGMA synchronous").scalar(),
            connection.exec_driver_sql("PRAGMA journal_mode").scalar(),
        )
    ).result()
    assert pragmas == (2, "wal")


def test_a_reader_sees_the_last_commit_while_a_write_is_under_way(bare):
    bare.submit(add("before")).result()
    begun, go_on = Event(), Event()

    def slow(connection):
        add("during")(connection)
        begun.set()
        go_on.wait(10)

    writing = bare.submit(slow)
    assert begun.wait(10)
    assert names(bare) == {"before"}
    go_on.set()
    writing.result()
    assert names(bare) == {"before", "during"}


def test_closing_finishes_what_is_queued(settings):
    database = Database(settings.database_url)
    go_on = hold(database)
    queued = [database.submit(add(f"n{i}")) for i in range(20)]
    go_on.set()
    database.close()
    assert all(future.done() for future in queued)
    reopened = Database(settings.database_url)
    assert len(names(reopened)) == 20
    reopened.close()


def test_two_databases_on_one_file_take_turns(bare, settings):
    other = Database(settings.database_url)
    futures = [
        database.submit(add(f"n{i}")) for i in range(30) for database in (bare, other)[i % 2 :][:1]
    ]
    wait(futures)
    assert not any(future.exception() for future in futures)
    assert len(names(bare)) == 30
    other.close()


def test_opening_a_new_file_waits_for_another_process_that_writes_to_it(settings):
    with (
        closing(sqlite3.connect(settings.database_file)) as other,
        ThreadPoolExecutor() as elsewhere,
    ):
        other.execute("BEGIN IMMEDIATE")
        opening = elsewhere.submit(Database, settings.database_url)
        assert not wait([opening], timeout=0.2).done
        other.rollback()
        opening.result().close()


def test_who_waits_for_another_process_asks_often_enough_to_find_it_idle(bare, settings):
    asked = Semaphore(0)
    event.listen(bare._writer, "before_cursor_execute", lambda *_: asked.release())
    with closing(sqlite3.connect(settings.database_file)) as other:
        other.execute("BEGIN IMMEDIATE")
        waiting = bare.submit(add("one"))
        assert all(asked.acquire(timeout=5) for _ in range(10))
        assert not waiting.done()
        other.rollback()
        waiting.result()


def test_a_write_that_was_given_up_harms_nobody_else(bare):
    go_on = hold(bare)
    given_up, after = bare.submit(add("given up")), bare.submit(add("after"))
    assert given_up.cancel()
    go_on.set()
    after.result()
    assert names(bare) == {"after"}
