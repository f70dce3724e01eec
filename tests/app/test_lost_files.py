"""A database whose files are removed, moved or replaced while a server has it open."""

import logging
import os
import shutil
import sqlite3
import subprocess
import sys
from contextlib import closing

import httpx2
import pytest
from sqlalchemy import insert, select

from app.database import Database
from app.errors import DatabaseUnavailable
from app.tables import tallies
from tests.app.conftest import Browser
from tests.server_process import ServerProcess


def add(name):
    return lambda connection: connection.execute(insert(tallies).values(name=name, count=1))


def names(file):
    with closing(sqlite3.connect(file)) as connection:
        return {name for (name,) in connection.execute("SELECT name FROM tallies")}


def log_of(file):
    return file.with_name(f"{file.name}-wal")


def remove(file):
    file.unlink()


def move(file):
    file.rename(file.with_name("elsewhere.sqlite"))


def replace_by_a_copy_of_itself(file):
    copy = file.with_name("copy.sqlite")
    shutil.copy(file, copy)
    copy.replace(file)


def remove_the_log(file):
    log_of(file).unlink()


def overwrite(file):
    os.truncate(file, 4096)


ACCIDENTS = [remove, move, replace_by_a_copy_of_itself, remove_the_log, overwrite]


@pytest.fixture
def lost(settings, request):
    """A database with an acknowledged write, after an accident and one more write."""
    database = Database(settings.database_url)
    database.submit(add("acknowledged")).result()
    request.param(settings.database_file)
    yield database
    database.close()


@pytest.mark.parametrize("lost", ACCIDENTS, indirect=True)
def test_nothing_is_acknowledged_or_read_once_the_files_are_lost(lost, caplog):
    with caplog.at_level(logging.CRITICAL), pytest.raises(DatabaseUnavailable):
        lost.submit(add("later")).result()
    with pytest.raises(DatabaseUnavailable, match="any more"):
        lost.submit(add("later still")).result()
    with pytest.raises(DatabaseUnavailable, match="any more"):
        lost.read_now(lambda connection: connection.execute(select(tallies)).all())
    (said,) = caplog.messages
    assert "goalguess restore" in said or "restore your last backup" in said


@pytest.mark.parametrize("lost", ACCIDENTS[:-1], indirect=True)
def test_all_that_was_acknowledged_is_in_the_rescued_copy(lost, settings):
    with pytest.raises(DatabaseUnavailable):
        lost.submit(add("later")).result()
    (rescued,) = settings.database_file.parent.glob("*.rescued-*")
    assert "acknowledged" in names(rescued)
    assert rescued.stat().st_mode & 0o777 == 0o600


def test_a_folder_that_is_gone_is_told_with_what_to_do(settings, tmp_path, caplog):
    folder = tmp_path / "folder"
    folder.mkdir()
    shutil.move(settings.database_file, folder)
    database = Database(f"sqlite:///{folder}/study.sqlite")
    folder.rename(tmp_path / "elsewhere")
    with pytest.raises(DatabaseUnavailable):
        database.submit(add("later")).result()
    database.close()
    (said,) = caplog.messages
    assert "Put the files back and start again; no copy could be made" in said


@pytest.mark.parametrize("lost", [move], indirect=True)
def test_files_put_back_hold_all_that_was_acknowledged(lost, settings):
    with pytest.raises(DatabaseUnavailable):
        lost.submit(add("later")).result()
    lost.close()
    settings.database_file.with_name("elsewhere.sqlite").rename(settings.database_file)
    with closing(Database(settings.database_url)) as reopened:
        found = reopened.read_now(lambda c: set(c.scalars(select(tallies.c.name))))
    assert "acknowledged" in found


LOSE_THE_LOG = """
import sys
from pathlib import Path
from app.database import Database

log, noticed = Path(sys.argv[1] + "-wal"), sys.argv[2] == "True"
database = Database("sqlite:///" + sys.argv[1])
database.submit(lambda c: c.exec_driver_sql("INSERT INTO tallies VALUES ('one', 1)")).result()
log.unlink()
log.write_text("of another database")
if noticed:
    database.submit(lambda c: c.exec_driver_sql("DELETE FROM tallies")).exception()
database.close()
"""


@pytest.mark.parametrize("noticed", [True, False])
def test_a_process_that_ends_leaves_alone_the_log_that_lies_there_now(settings, noticed):
    file = settings.database_file
    subprocess.run([sys.executable, "-c", LOSE_THE_LOG, file, str(noticed)], check=True)
    assert log_of(file).read_text() == "of another database"


def test_participants_are_asked_to_wait_and_lose_nothing_when_the_file_is_put_back(tmp_path):
    file, elsewhere = tmp_path / "study.sqlite", tmp_path / "elsewhere.sqlite"
    with (
        ServerProcess(file) as server,
        httpx2.Client(base_url=server.url, headers={"host": "study.test"}) as client,
    ):
        browser = Browser(client)
        browser.reach_trials()
        assert browser.finish_trial(1, "C").status_code == 200
        browser.play(2)
        file.rename(elsewhere)
        unheard = browser.stop(2, 3000)
        assert (unheard.status_code, unheard.json()["error"]["code"]) == (503, "unavailable")
        page = browser.get("/trial")
        assert page.status_code == 503
        assert "cannot store anything just now" in page.text
        assert "sqlite" not in page.text
        server.stop()
        elsewhere.rename(file)
        server.start()
        assert browser.stop(2, 3000).status_code == 200
        assert browser.answer(2).status_code == 200
    with closing(sqlite3.connect(file)) as connection:
        answered = "SELECT trial_index, guess FROM trials WHERE answered_at IS NOT NULL"
        assert connection.execute(answered).fetchall() == [(1, "C"), (2, "A")]
