"""`goalguess restore`: a backup in the place of the database, or nothing changed at all."""

import re
import shutil
import sqlite3
from contextlib import closing
from urllib.request import urlopen

import pytest

import app.schema
from app import enrolment
from app.backup import back_up, restore
from app.errors import AppError, DatabaseUnavailable
from app.opening import open_database
from app.schema import prepare
from tests.app.stored import answers_in, as_killed, contents, pseudonym, take_part
from tests.app.test_backup import unseen
from tests.app.test_cli import run
from tests.app.test_unavailable import damage
from tests.server_process import ServerProcess


@pytest.fixture
def file(settings):
    return settings.database_file


@pytest.fixture
def backup(study, file, tmp_path):
    """Two people with three answers each; afterwards the first withdraws, and a third comes."""
    to = tmp_path / "backups" / "backup.sqlite"
    to.parent.mkdir()
    with closing(open_database(study)) as database:
        first = take_part(database, study, answers=3)
        take_part(database, study, answers=3)
        back_up(file, to, unseen)
        database.submit(lambda c: enrolment.withdraw(c, study, first)).result()
        take_part(database, study, answers=1)
    return to


def test_a_backup_takes_the_place_without_who_withdrew_since(study, file, backup):
    restored = restore(study, backup, unseen)
    assert (restored.holds, restored.dropped) == ("1 participant and 3 answers", 1)
    assert answers_in(file) == 3
    assert answers_in(backup) == 6
    assert file.stat().st_mode & 0o777 == 0o600
    with closing(open_database(study)) as database:
        take_part(database, study, answers=1)


def test_what_was_replaced_is_kept_and_opens(study, backup):
    replaced = restore(study, backup, unseen).replaced
    assert replaced
    assert replaced.name.startswith("study.sqlite.replaced-2")
    assert replaced.stat().st_mode & 0o777 == 0o600
    assert answers_in(replaced) == 4


def test_the_log_of_a_killed_server_is_kept_with_its_database_and_not_used(
    study, file, backup, tmp_path
):
    with closing(open_database(study)) as database:
        take_part(database, study, answers=5)
        killed = as_killed(file, tmp_path / "killed")
    for one in file.parent.glob("study.sqlite*"):
        if not one.name.endswith(".withdrawn"):
            one.unlink()
    for one in killed.parent.iterdir():
        shutil.copy(one, file.parent)
    replaced = restore(study, backup, unseen).replaced
    names = {one.name for one in file.parent.iterdir()}
    assert not {"study.sqlite-wal", "study.sqlite-shm"} & names
    assert answers_in(file) == 3
    assert replaced
    assert answers_in(replaced) == 9


def test_a_stale_log_beside_nothing_is_put_aside_too(study, file, backup):
    file.unlink()
    log = file.with_name("study.sqlite-wal")
    log.write_text("of some other database")
    replaced = restore(study, backup, unseen).replaced
    assert replaced
    assert not log.exists()
    kept = replaced.with_name(f"{replaced.name}-wal")
    assert kept.read_text() == "of some other database"
    assert answers_in(file) == 3


@pytest.mark.usefixtures("backup")
def test_a_backup_with_a_log_beside_it_is_read_through_it(study, file, tmp_path):
    with closing(open_database(study)) as database:
        take_part(database, study, answers=5)
        killed = as_killed(file, tmp_path / "killed")
    file.unlink()
    assert restore(study, killed, unseen).holds == "3 participants and 9 answers"


@pytest.mark.parametrize("harm", [lambda _file: None, damage], ids=["sound", "damaged"])
def test_nothing_is_restored_while_a_server_has_the_database(study, file, backup, harm):
    with ServerProcess(file) as server:
        urlopen(server.url).close()
        harm(file)
        before = contents(file.parent)
        with pytest.raises(DatabaseUnavailable, match="another process has it open"):
            restore(study, backup, unseen)
        assert contents(file.parent) == before
    if harm != damage:
        assert restore(study, backup, unseen).replaced


def test_a_damaged_database_can_be_replaced(study, file, backup):
    damage(file)
    assert restore(study, backup, unseen).holds == "1 participant and 3 answers"


def itself(backup, file):
    backup.unlink()
    backup.hardlink_to(file)


def of_another_program(backup, _file):
    backup.unlink()
    with closing(sqlite3.connect(backup)) as connection:
        connection.execute("CREATE TABLE recipes (name TEXT)")


def of_a_later_version(backup, _file):
    with closing(sqlite3.connect(backup)) as connection, connection:
        connection.execute("UPDATE alembic_version SET version_num = '9999'")


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (itself, "found the study's database itself"),
        (of_another_program, "tables of another program"),
        (of_a_later_version, "found version '9999'"),
        (lambda backup, _file: damage(backup), "it is damaged"),
        (lambda backup, _file: backup.write_text("Dear diary, " * 99), "found something else"),
        (lambda backup, _file: backup.unlink(), "found no such file"),
    ],
)
def test_what_cannot_be_restored_changes_nothing(study, file, backup, spoil, message):
    spoil(backup, file)
    before = contents(file.parent)
    with pytest.raises(AppError, match=message) as refused:
        restore(study, backup, unseen)
    assert str(backup) in str(refused.value)
    assert contents(file.parent) == before


def test_a_backup_of_an_older_version_is_brought_up_to_date(study, tmp_path, monkeypatch):
    older = tmp_path / "older.sqlite"
    with monkeypatch.context() as patched:
        patched.setattr(app.schema, "HEAD", "0001")
        prepare(f"sqlite:///{older}", str(older))
    before = older.read_bytes()
    assert restore(study, older, unseen).holds == "0 participants and 0 answers"
    assert older.read_bytes() == before
    open_database(study).close()


def test_the_command_says_what_is_there_now_and_where_the_rest_went(file, backup):
    done = run("restore", backup, GOALGUESS_DATABASE_URL=f"sqlite:///{file}")
    assert done.returncode == 0
    assert f"{file}: 1 participant and 3 answers, as in {backup}." in done.stdout
    assert f"Left out by {file}.withdrawn, as they have withdrawn since: 1." in done.stdout
    assert re.search(r"study\.sqlite\.replaced-\w+: \d+ participants? and \d+ answers", done.stdout)
    assert "Whoever came after the backup is in it alone" in done.stdout
    assert "personal data" in done.stdout


def test_a_missing_list_of_withdrawals_is_told(study, file, backup):
    study.settings.withdrawals_file.unlink()
    done = run("restore", backup, GOALGUESS_DATABASE_URL=f"sqlite:///{file}")
    assert "No list of who withdrew" in done.stderr
    assert not study.settings.withdrawals_file.exists()


def test_a_listed_pseudonym_is_the_only_thing_that_drops_somebody(study, backup):
    with closing(open_database(study)) as database:
        token = take_part(database, study, answers=1)
        listed = pseudonym(database, token)
    study.settings.withdrawals_file.write_text(f"{listed}\n")
    assert restore(study, backup, unseen).dropped == 0
