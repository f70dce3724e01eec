"""The files of a database: whose they are, and what is said of them at the start."""

from contextlib import closing

import pytest

from app.opening import open_database, start_line, start_warnings
from app.study import PREVIEW, SIMULATED, load_study
from tests.app.stored import take_part


@pytest.fixture
def new(settings, tmp_path):
    """A study whose database does not exist yet."""
    folder = tmp_path / "new"
    folder.mkdir()
    url = f"sqlite:///{folder}/study.sqlite"
    return load_study(settings.model_copy(update={"database_url": url}))


def test_all_files_that_a_study_makes_are_its_owners_alone(new):
    with closing(open_database(new)) as database:
        take_part(database, new, answers=1)
        modes = {
            file.name: file.stat().st_mode & 0o777
            for file in new.settings.database_file.parent.iterdir()
        }
    names = ("study.sqlite", "study.sqlite-wal", "study.sqlite-shm", "study.sqlite.withdrawn")
    assert modes == dict.fromkeys(names, 0o600)


def test_files_that_others_may_read_are_named_and_left_as_they_are(new):
    open_database(new).close()
    assert start_warnings(new) == []
    file, listed = new.settings.database_file, new.settings.withdrawals_file
    for one in (file, listed):
        one.chmod(0o644)
    (warning,) = start_warnings(new)
    assert warning.endswith(f"chmod 600 {file} {listed}")
    open_database(new).close()
    assert file.stat().st_mode & 0o777 == 0o644


def test_the_start_says_where_answers_go_and_that_the_file_is_new(new):
    file = new.settings.database_file
    with closing(open_database(new)) as database:
        line = start_line(new, is_new=True, database=database)
    assert line == f"Answers go to {file}, a new file: nobody has taken part yet."


def test_the_start_says_how_many_are_in_the_database_pilots_apart(new, monkeypatch):
    monkeypatch.chdir(new.settings.database_file.parent)
    with closing(open_database(new)) as database:
        take_part(database, new, answers=2)
        take_part(database, new, answers=1, stream=PREVIEW)
        take_part(database, new, answers=0, stream=SIMULATED)
        relative = new.settings.model_copy(update={"database_url": "sqlite:///study.sqlite"})
        line = start_line(load_study(relative), is_new=False, database=database)
    file = new.settings.database_file
    assert (
        line == f"Answers go to {file}, which holds 1 participant and 2 answers (2 pilots apart)."
    )


def test_a_database_reached_by_a_link_is_served_and_kept_whole(new, tmp_path):
    real = tmp_path / "elsewhere.sqlite"
    new.settings.database_file.symlink_to(real)
    with closing(open_database(new)) as database:
        take_part(database, new, answers=1)
    assert real.stat().st_mode & 0o777 == 0o600
    assert {file.name for file in new.settings.database_file.parent.iterdir()} == {
        "study.sqlite",
        "study.sqlite.withdrawn",
    }
