"""`goalguess export`: from any copy of a database, which it does not change by a byte."""

import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

import app.schema
from app.backup import snapshot
from app.copying import oddities
from app.errors import DatabaseMismatch
from app.opening import open_database
from app.settings import Settings
from app.sqlite import url_of
from app.study import load_study
from tests.app.stored import as_killed, contents, pseudonym, take_part
from tests.app.test_backup import unseen
from tests.app.test_schema import ROWS_OF_THE_FIRST_VERSION, prepare_file
from tests.app.test_unavailable import run


@pytest.fixture
def killed(database, study, settings, tmp_path):
    """The files of a server that was killed: two answers, all of them in the log."""
    take_part(database, study, answers=2)
    return with_list(as_killed(settings.database_file, tmp_path / "killed"))


@pytest.fixture
def closed(study, settings):
    """A database with two answers that was closed."""
    with closing(open_database(study)) as database:
        take_part(database, study, answers=2)
    folder = settings.database_file.parent / "closed"
    folder.mkdir()
    return with_list(Path(shutil.copy(settings.database_file, folder)))


def with_list(file):
    """A database with its list of withdrawals, on which nobody is."""
    file.with_name(f"{file.name}.withdrawn").touch()
    return file


def test_a_copy_without_the_list_of_withdrawals_is_said_to_leave_nobody_out(closed, tmp_path):
    closed.with_name(f"{closed.name}.withdrawn").unlink()
    done = run(closed, "export", "--to", str(tmp_path / "out"))
    assert done.stderr.startswith(f"No list of who withdrew ({closed}.withdrawn)")
    assert done.returncode == 0


def without_index(file):
    file.with_name(f"{file.name}-shm").unlink()


@pytest.mark.parametrize("leave_out", [without_index, lambda _file: None])
def test_a_database_in_a_folder_that_is_read_only_is_exported(killed, leave_out, tmp_path):
    leave_out(killed)
    before = contents(killed.parent), {file.name for file in killed.parent.iterdir()}
    for file in killed.parent.iterdir():
        file.chmod(0o444)
    killed.parent.chmod(0o555)
    done = run(killed, "export", "--to", str(tmp_path / "out"))
    killed.parent.chmod(0o755)
    assert (done.returncode, done.stderr) == (0, "")
    assert "2 trials, 1 participants" in done.stdout
    assert (contents(killed.parent), {f.name for f in killed.parent.iterdir()}) == before


def test_a_closed_database_is_exported_without_a_word_and_without_a_trace(closed, tmp_path):
    before = contents(closed.parent)
    done = run(closed, "export", "--to", str(tmp_path / "out"))
    assert (done.returncode, done.stderr) == (0, "")
    assert "2 trials" in done.stdout
    assert contents(closed.parent) == before
    assert {file.name for file in closed.parent.iterdir()} == {
        closed.name,
        f"{closed.name}.withdrawn",
    }


def test_a_copy_of_a_database_in_use_without_its_log_is_said_to_lack_answers(killed, tmp_path):
    killed.with_name(f"{killed.name}-wal").unlink()
    done = run(killed, "export", "--to", str(tmp_path / "out"))
    assert "0 trials" in done.stdout
    (line,) = done.stderr.splitlines()
    assert "has no log (study.sqlite-wal) beside it" in line
    assert "goalguess backup" in line


def of_another_page_size(log):
    with closing(sqlite3.connect(log.with_name("other.sqlite"))) as other:
        other.execute("PRAGMA page_size=8192")
        other.execute("PRAGMA journal_mode=WAL")
        other.execute("CREATE TABLE recipes (name TEXT)")
        other.commit()
        shutil.copy(log.with_name("other.sqlite-wal"), log)


def with_a_bit_changed(log):
    with log.open("r+b") as opened:
        opened.seek(17)
        opened.write(bytes([log.read_bytes()[17] ^ 1]))


@pytest.mark.parametrize(
    "spoil",
    [
        of_another_page_size,
        with_a_bit_changed,
        lambda log: log.write_bytes(b"short"),
        lambda log: log.write_text("Dear diary, " * 99),
    ],
)
def test_a_log_that_does_not_fit_is_told(killed, spoil):
    log = killed.with_name(f"{killed.name}-wal")
    spoil(log)
    (line,) = oddities(killed)
    assert line.startswith(f"{log} is not the log of study.sqlite, or is damaged")


def test_a_log_that_fits_is_not_odd_nor_is_an_empty_one(killed):
    assert oddities(killed) == []
    killed.with_name(f"{killed.name}-wal").write_bytes(b"")
    assert oddities(killed) == []


def test_a_study_that_never_ran_is_not_registered(closed):
    settings = Settings(database_url=f"sqlite:///{closed}", step_ms=777)
    before = contents(closed.parent)
    with snapshot(load_study(settings), unseen):
        pass
    assert contents(closed.parent) == before
    assert {file.name for file in closed.parent.iterdir()} == {
        closed.name,
        f"{closed.name}.withdrawn",
    }


def test_a_database_of_the_first_version_is_read_and_stays_as_it_is(tmp_path, monkeypatch):
    file = tmp_path / "older.sqlite"
    with monkeypatch.context() as patched:
        patched.setattr(app.schema, "HEAD", "0001")
        prepare_file(file)
    study = load_study(Settings(database_url=f"sqlite:///{file}"))
    with closing(sqlite3.connect(file)) as connection:
        rows = ROWS_OF_THE_FIRST_VERSION.replace("'pool'", f"'{study.pool.hash}'")
        connection.executescript(rows)
    before = contents(tmp_path)
    with snapshot(study, unseen) as database:
        names = database.read_now(
            lambda c: c.exec_driver_sql("SELECT pseudonym FROM participants").all()
        )
    assert names == [("ada",), ("bob",), ("eve",)]
    assert contents(tmp_path) == before


def test_who_withdrew_is_left_out_of_an_export_from_an_old_backup(study, settings, tmp_path):
    with closing(open_database(study)) as database:
        listed = pseudonym(database, take_part(database, study, answers=2))
    settings.withdrawals_file.write_text(listed)
    settings.withdrawals_file.chmod(0o444)
    done = run(settings.database_file, "export", "--to", str(tmp_path / "out"))
    assert "0 trials, 1 participants" in done.stdout


def test_another_pool_is_refused(killed, study):
    with closing(sqlite3.connect(killed)) as connection, connection:
        connection.execute("UPDATE studies SET pool_hash = ?", ("f" * 64,))
    study = load_study(Settings(database_url=f"sqlite:///{killed}"))
    with pytest.raises(DatabaseMismatch, match="found ffffffffffff"), snapshot(study, unseen):
        pass


def test_a_snapshot_is_private_and_goes_away(closed, tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    before = set(tmp_path.iterdir())
    with snapshot(load_study(Settings(database_url=str(url_of(closed)))), unseen):
        (made,) = set(tmp_path.iterdir()) - before
        assert made.stat().st_mode & 0o777 == 0o700
        assert all(file.stat().st_mode & 0o077 == 0 for file in made.iterdir())
    assert set(tmp_path.iterdir()) == before
