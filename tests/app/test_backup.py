"""`goalguess backup`: the whole database in one file, while the study runs."""

import sqlite3
from contextlib import closing
from threading import Event, Thread
from unittest.mock import Mock

import pytest

from app.backup import back_up
from app.errors import DatabaseMismatch, DatabaseUnavailable, InvalidInput
from app.study import PREVIEW
from tests.app.stored import answers_in, take_part
from tests.app.test_cli import run


def unseen(_done, _of):
    """Nobody watches how far it is."""


@pytest.fixture
def file(settings):
    return settings.database_file


def test_a_backup_of_a_database_in_use_holds_all_that_was_acknowledged(
    database, study, file, tmp_path
):
    take_part(database, study, answers=3)
    take_part(database, study, answers=0, stream=PREVIEW)
    held = back_up(file, tmp_path / "backup.sqlite", unseen)
    assert held == "1 participant and 3 answers (1 pilot apart)"
    assert answers_in(tmp_path / "backup.sqlite") == 3


def test_a_backup_is_one_file_that_only_its_owner_may_read(database, study, file, tmp_path):
    take_part(database, study, answers=1)
    folder = tmp_path / "backups"
    folder.mkdir()
    back_up(file, folder / "backup.sqlite", unseen)
    (backup,) = folder.iterdir()
    assert backup.stat().st_mode & 0o777 == 0o600
    with closing(sqlite3.connect(backup)) as connection:
        assert connection.execute("PRAGMA journal_mode").fetchone() == ("delete",)


def test_a_backup_shows_one_moment_of_a_database_that_never_rests(
    database, file, tmp_path, monkeypatch
):
    monkeypatch.setattr("app.copying.PAGES_AT_ONCE", 1)
    rested = Event()

    def go_on():
        while not rested.is_set():
            database.submit(
                lambda c: c.exec_driver_sql(
                    "INSERT INTO tallies VALUES ('n', 1) ON CONFLICT DO UPDATE SET count = count+1"
                )
            ).result()

    writing = Thread(target=go_on)
    writing.start()
    try:
        back_up(file, tmp_path / "backup.sqlite", unseen)
    finally:
        rested.set()
        writing.join()
    assert answers_in(tmp_path / "backup.sqlite") == 0


def test_how_far_a_backup_is_can_be_seen(database, study, file, tmp_path, monkeypatch):
    take_part(database, study, answers=1)
    monkeypatch.setattr("app.copying.PAGES_AT_ONCE", 5)
    seen = []
    back_up(file, tmp_path / "backup.sqlite", lambda done, of: seen.append(done / of))
    assert seen == sorted(seen)
    assert len(seen) > 3
    assert seen[-1] == 1


def test_an_existing_file_is_never_overwritten(file, tmp_path):
    taken = tmp_path / "taken.sqlite"
    taken.write_text("mine")
    with pytest.raises(InvalidInput, match=r"taken\.sqlite: expected the name of a new file"):
        back_up(file, taken, unseen)
    assert taken.read_text() == "mine"


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("none.sqlite", "found no such file"),
        ("notes.sqlite", "found something else"),
        ("empty.sqlite", "found an empty one"),
        ("recipes.sqlite", "tables of another program"),
    ],
)
def test_what_is_no_study_is_not_backed_up_and_nothing_is_left(tmp_path, source, message):
    (tmp_path / "notes.sqlite").write_text("Dear diary, " * 200)
    (tmp_path / "empty.sqlite").touch()
    with closing(sqlite3.connect(tmp_path / "recipes.sqlite")) as other:
        other.execute("CREATE TABLE recipes (name TEXT)")
    folder = tmp_path / "backups"
    folder.mkdir()
    with pytest.raises(DatabaseMismatch, match=message):
        back_up(tmp_path / source, folder / "backup.sqlite", unseen)
    assert list(folder.iterdir()) == []


def test_a_disk_without_room_for_the_copy_is_told_and_nothing_is_left(file, tmp_path, monkeypatch):
    full = sqlite3.OperationalError("database or disk is full")
    full.sqlite_errorcode = sqlite3.SQLITE_FULL
    monkeypatch.setattr("app.copying.write_copy", Mock(side_effect=full))
    before = set(tmp_path.iterdir())
    with pytest.raises(DatabaseUnavailable, match=r"study\.sqlite: its copy has no room"):
        back_up(file, tmp_path / "backup.sqlite", unseen)
    assert set(tmp_path.iterdir()) == before


def test_the_command_says_what_is_in_it_and_what_is_not(database, study, file, tmp_path):
    take_part(database, study, answers=2)
    to = tmp_path / "backup.sqlite"
    done = run("backup", "--to", to, GOALGUESS_DATABASE_URL=f"sqlite:///{file}")
    assert done.returncode == 0
    assert done.stdout == f"{to}: 1 participant and 2 answers, whole and checked.\n"
    assert f"{file}.withdrawn" in done.stderr
