"""What withdrew leaves the write-ahead log too, soon, and nobody waits for it."""

import asyncio
import sqlite3
import time
from contextlib import closing, contextmanager

import pytest

from app import books, enrolment
from app.database import FORGET_WITHIN_S, Database
from app.opening import open_database
from tests import messages
from tests.app import people

TOLD = {**messages.ABOUT_ME, "nationality": "Unmistakably Atlantean"}


def log_of(settings):
    return settings.database_file.with_name(f"{settings.database_file.name}-wal")


def holds_what_was_told(settings):
    return TOLD["nationality"].encode() in log_of(settings).read_bytes()


def becomes_true(holds):
    until = time.monotonic() + 5
    while not holds() and time.monotonic() < until:
        time.sleep(0.01)
    return holds()


@contextmanager
def reader(settings):
    """Somebody who reads the database as it is now, for as long as they like."""
    with closing(sqlite3.connect(settings.database_file, isolation_level=None)) as other:
        other.execute("BEGIN")
        other.execute("SELECT count(*) FROM participants").fetchone()
        yield


@pytest.fixture
def told(browser, settings):
    browser.consent()
    browser.post("/about-you", TOLD)
    assert holds_what_was_told(settings)
    return browser


def test_with_the_reply_to_a_withdrawal_the_log_is_empty(told, settings):
    told.post("/withdraw")
    assert not holds_what_was_told(settings)


def test_a_reader_of_an_older_state_delays_the_emptying_and_nobody_else(
    told, another_browser, settings
):
    with reader(settings):
        begun = time.monotonic()
        assert told.post("/withdraw").headers["location"] == "/withdrawn"
        another_browser().reach_trials()
        assert time.monotonic() - begun < FORGET_WITHIN_S + 2
        assert holds_what_was_told(settings)
    assert becomes_true(lambda: not holds_what_was_told(settings))


def test_others_are_served_while_a_withdrawal_waits_for_the_log(database, study, monkeypatch):
    monkeypatch.setattr("app.database.FORGET_WITHIN_S", 60)

    async def ask_and_go_on():
        asking = asyncio.create_task(database.forget_deleted())
        await asyncio.sleep(0)
        await asyncio.wait_for(database.write(lambda c: people.consent(c, study)), 5)
        await database.read(books.count_participants)
        assert not asking.done()
        asking.cancel()

    token = database.submit(lambda c: people.consent(c, study)).result()
    database.submit(lambda c: enrolment.withdraw(c, study, token)).result()
    with reader(study.settings):
        database.submit(lambda c: people.consent(c, study)).result()
        asyncio.run(ask_and_go_on())


def test_a_log_that_could_not_be_emptied_before_a_kill_is_emptied_at_the_next_start(settings):
    """Another process has the database open, so that closing does not empty it either."""
    with closing(sqlite3.connect(settings.database_file, isolation_level=None)) as other:
        other.execute("PRAGMA journal_mode=WAL")
        other.execute("INSERT INTO tallies VALUES (?, 1)", (TOLD["nationality"],))
        other.execute("DELETE FROM tallies")
        assert holds_what_was_told(settings)
        with closing(Database(settings.database_url)):
            assert becomes_true(lambda: not holds_what_was_told(settings))


def test_closing_does_not_wait_for_a_log_that_cannot_be_emptied(database, study):
    token = database.submit(lambda c: people.consent(c, study)).result()
    other = open_database(study)
    other.submit(lambda c: enrolment.withdraw(c, study, token)).result()
    with reader(study.settings):
        other.submit(lambda c: people.consent(c, study)).result()
        begun = time.monotonic()
        other.close()
        assert time.monotonic() - begun < 2
