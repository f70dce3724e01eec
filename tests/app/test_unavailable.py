"""A database that cannot store just now: one line for who runs the study, patience for others."""

import os
import sqlite3
import subprocess
import sys
import threading
from contextlib import closing, contextmanager
from ctypes import CDLL
from functools import partial

import pytest
from sqlalchemy import insert
from sqlalchemy.exc import IntegrityError

import app.sqlite
from app.database import Database
from app.errors import DatabaseUnavailable
from app.opening import open_database
from app.sqlite import sqlite_engine
from app.tables import recruits, tallies
from tests import messages


@contextmanager
def held(file, begin="BEGIN IMMEDIATE"):
    """The database in the hands of another connection, for no longer than five seconds."""
    connect = partial(sqlite3.connect, isolation_level=None, check_same_thread=False)
    with closing(connect(file)) as other:
        other.execute(begin)
        # Who never gives up waiting fails the test, and does not stop the run.
        timer = threading.Timer(5, other.rollback)
        timer.start()
        yield
        timer.cancel()
        timer.join()


def add(name):
    return lambda connection: connection.execute(insert(tallies).values(name=name, count=1))


@pytest.fixture
def impatient(monkeypatch):
    monkeypatch.setattr(app.sqlite, "BUSY_MS", 100)


def damage(file):
    """Zeros over the middle of the file, as a failing disk leaves them."""
    size = file.stat().st_size
    with file.open("r+b") as opened:
        opened.seek(size // 2 - size // 2 % 4096)
        opened.write(bytes(3 * 4096))


def _give_up_power_over_files():
    """A user root no longer writes what it may not: for processes started from here on."""
    if os.getuid() == 0:
        drop_from_bounding_set, dac_override = 24, 1
        assert CDLL(None).prctl(drop_from_bounding_set, dac_override, 0, 0, 0) == 0


def run(file, *words):
    return subprocess.run(
        [sys.executable, "-m", "app.cli", *words],
        capture_output=True,
        text=True,
        env={**os.environ, "GOALGUESS_DATABASE_URL": f"sqlite:///{file}"},
        preexec_fn=_give_up_power_over_files,
        timeout=60,
        check=False,
    )


COMMANDS = [["serve", "--port", "0"], ["simulate", "--participants", "1"]]
EXPORT = ["export", "--to", "out"]
BACKUP = ["backup", "--to", "out.sqlite"]


@pytest.mark.parametrize("words", [*COMMANDS, EXPORT, BACKUP], ids=" ".join)
def test_a_damaged_page_is_one_line_at_the_start(study, settings, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    open_database(study).close()
    damage(settings.database_file)
    before = settings.database_file.read_bytes()
    done = run(settings.database_file, *words)
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert "study.sqlite: it is damaged" in line
    assert settings.database_file.read_bytes() == before
    assert {file.name for file in tmp_path.iterdir()} == {"study.sqlite", "study.sqlite.withdrawn"}


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_a_file_that_may_not_be_written_is_one_line(study, settings, words):
    open_database(study).close()
    settings.database_file.chmod(0o444)
    done = run(settings.database_file, *words)
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert "study.sqlite: it can be read, but not written to" in line


@pytest.mark.parametrize("words", [*COMMANDS, EXPORT, BACKUP], ids=" ".join)
def test_a_folder_in_place_of_the_file_is_one_line(tmp_path, words):
    done = run(tmp_path, *words)
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert line.endswith("found a folder") or "found a folder;" in line


def test_a_stale_log_is_named_as_what_may_be_wrong_and_nothing_is_changed(study, settings):
    file = settings.database_file
    log = file.with_name(f"{file.name}-wal")
    with closing(open_database(study)) as database:
        for n in range(300):
            database.submit(add(f"{n} {'x' * 200}")).result()
        stale = log.read_bytes()
    with closing(sqlite3.connect(file)) as other:
        other.execute("DELETE FROM tallies")
        other.commit()
        other.execute("CREATE TABLE filler AS SELECT randomblob(100000)")
        other.execute("PRAGMA journal_mode=WAL")
    log.write_bytes(stale)
    before = file.read_bytes(), log.read_bytes()
    with pytest.raises(DatabaseUnavailable, match="or -wal beside it belongs to another file"):
        open_database(study)
    assert (file.read_bytes(), log.read_bytes()) == before


@pytest.mark.usefixtures("impatient")
def test_a_locked_database_is_said_to_be_locked_at_the_start(study, settings):
    open_database(study).close()
    with (
        held(settings.database_file, "BEGIN EXCLUSIVE"),
        pytest.raises(DatabaseUnavailable, match="another program is writing to it, or has it lo"),
    ):
        open_database(study)


def test_opening_waits_for_who_has_the_database_locked(study, settings):
    open_database(study).close()
    opened = []
    with held(settings.database_file, "BEGIN EXCLUSIVE"):
        opening = threading.Thread(target=lambda: opened.append(open_database(study)))
        opening.start()
        opening.join(0.3)
        assert opening.is_alive()
    opening.join(10)
    opened.pop().close()


@pytest.mark.usefixtures("impatient")
def test_a_page_says_to_try_again_while_the_database_is_locked(browser, settings, caplog):
    browser.consent()
    with held(settings.database_file):
        reply = browser.post("/about-you", messages.ABOUT_ME)
        assert (reply.status_code, reply.headers["retry-after"]) == (503, "5")
        assert "load this page again in a moment" in reply.text
        assert "study.sqlite" not in reply.text
        event = {"key": messages.key(), "events": [messages.event("hidden")]}
        error = browser.send("/api/events", event).json()["error"]
        assert error["code"] == "unavailable"
    assert any("another program is writing to it" in message for message in caplog.messages)
    assert browser.post("/about-you", messages.ABOUT_ME).status_code == 303


@pytest.mark.usefixtures("impatient")
def test_who_waits_to_write_gives_up_in_time(settings):
    database = Database(settings.database_url)
    with held(settings.database_file):
        waiting = database.submit(add("one"))
        with pytest.raises(DatabaseUnavailable, match="another program"):
            waiting.result(timeout=5)
    database.submit(add("two")).result()
    database.close()


def test_on_a_full_disk_nothing_is_acknowledged_and_later_all_goes_on(settings):
    database = Database(settings.database_url)
    driver = database._writer.connection.cursor()
    (pages,) = driver.execute("PRAGMA page_count").fetchone()
    driver.execute(f"PRAGMA max_page_count={pages}")
    full, small = database.submit(add("x" * 100_000)), database.submit(add("small"))
    with pytest.raises(DatabaseUnavailable, match="its disk is full"):
        full.result()
    small.exception()
    driver.execute("PRAGMA max_page_count=1000000")
    database.submit(add("x" * 100_000)).result()
    database.close()


def test_an_error_of_the_driver_names_no_values(settings):
    values = {"participant_id": 99, "stream": "participant", "recruiter_id": "unmistakable"}
    with (
        sqlite_engine(settings.database_url, "BEGIN").connect() as connection,
        pytest.raises(IntegrityError) as refused,
    ):
        connection.execute(insert(recruits), values)
    assert "unmistakable" not in str(refused.value)
