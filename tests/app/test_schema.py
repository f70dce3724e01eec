"""The schema: made by migrations, and only what is ours is opened."""

import sqlite3
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory

import app.schema
from app.errors import DatabaseMismatch
from app.schema import HEAD, prepare
from app.sqlite import sqlite_engine
from app.tables import metadata

ROWS_OF_THE_FIRST_VERSION = """
    INSERT INTO studies VALUES ('study', '{}', 'pool', '2025-03-01 09:00:00.000000');
    INSERT INTO participants (id, pseudonym, stream, step, study_hash, app_version, control_tries)
        VALUES (1, 'ada', 'participant', 'trials', 'study', '0.1.0', 1);
    INSERT INTO trials (participant_id, trial_index, stimulus, study_hash, app_version, step_ms,
            length_ms, lead_in_ms, played_at, position_ms, answered_at, guess)
        VALUES (1, 1, 'one', 'study', '0.1.0', 1000, 20000, 1500, '2025-03-01 09:10:00.000000', 0,
                '2025-03-01 09:10:20.000000', 'A'),
            (1, 2, 'two', 'study', '0.1.0', 1000, 18000, 1500, '2025-03-01 09:11:00.000000', 0,
                NULL, NULL);
    INSERT INTO participants (id, pseudonym, stream, step, study_hash, app_version, control_tries)
        VALUES (2, 'bob', 'participant', 'trials', 'study', '0.1.0', 1),
            (3, 'eve', 'participant', 'trials', 'study', '0.1.0', 1);
    INSERT INTO recruits VALUES (1, 'participant', 'a1 ', ' s1', 'x1'),
        (2, 'participant', 'b1', NULL, NULL), (3, 'participant', ' b1', NULL, NULL);
    INSERT INTO sessions VALUES ('token', 1, 1, '2025-03-01 09:05:00.000000');
"""


def prepare_file(file: Path) -> None:
    prepare(f"sqlite:///{file}", str(file))


def test_migrations_make_exactly_the_tables_that_the_code_declares(tmp_path):
    prepare_file(tmp_path / "new.sqlite")
    with sqlite_engine(f"sqlite:///{tmp_path}/new.sqlite", "BEGIN").connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), metadata) == []


def test_the_newest_migration_is_the_version_the_code_works_with():
    config = Config()
    folder = Path(app.schema.__file__).parent / "migrations"
    config.set_main_option("script_location", str(folder))
    assert ScriptDirectory.from_config(config).get_current_head() == HEAD


def test_preparing_again_changes_nothing(tmp_path):
    file = tmp_path / "study.sqlite"
    prepare_file(file)
    before = file.read_bytes()
    prepare_file(file)
    assert file.read_bytes() == before


def test_a_database_of_the_first_version_is_upgraded_and_keeps_its_rows(tmp_path, monkeypatch):
    file = tmp_path / "older.sqlite"
    with monkeypatch.context() as patched:
        patched.setattr(app.schema, "HEAD", "0001")
        prepare_file(file)
    with sqlite3.connect(file) as connection:
        connection.executescript(ROWS_OF_THE_FIRST_VERSION)
        before = connection.execute("SELECT * FROM trials").fetchall()
    prepare_file(file)
    with sqlite3.connect(file) as connection:
        after = connection.execute("SELECT * FROM trials").fetchall()
        proven = connection.execute("SELECT proven FROM sessions").fetchall()
        recruits = connection.execute("SELECT * FROM recruits ORDER BY 1").fetchall()
    assert recruits == [
        (1, "participant", "a1", "s1", "x1"),
        (2, "participant", "b1", None, None),
        (3, "participant", " b1", None, None),  # there is a b1 already
    ]
    assert len(before) == 2
    assert proven == [(1,)]  # whoever is under way may still withdraw
    kept = len(before[0])
    assert [row[:kept] for row in after] == before
    assert {value for row in after for value in row[kept:]} == {None}  # not known


def test_a_database_of_an_unknown_version_is_refused_and_not_touched(tmp_path):
    file = tmp_path / "newer.sqlite"
    prepare_file(file)
    with sqlite3.connect(file) as connection:
        connection.execute("UPDATE alembic_version SET version_num = '9999'")
    connection.close()
    before = file.read_bytes()
    with pytest.raises(DatabaseMismatch, match=r"newer\.sqlite.*found version '9999'"):
        prepare_file(file)
    assert file.read_bytes() == before


def test_a_database_of_another_program_is_refused_and_not_touched(tmp_path):
    file = tmp_path / "other.sqlite"
    with sqlite3.connect(file) as connection:
        connection.execute("CREATE TABLE recipes (name TEXT)")
    connection.close()
    before = file.read_bytes()
    with pytest.raises(DatabaseMismatch, match="tables of another program"):
        prepare_file(file)
    assert file.read_bytes() == before


def test_a_file_that_is_no_database_is_refused_in_one_line(tmp_path):
    file = tmp_path / "notes.sqlite"
    file.write_text("Dear diary, " * 200)
    with pytest.raises(DatabaseMismatch, match="expected a SQLite database") as error:
        prepare_file(file)
    assert "\n" not in str(error.value)
    assert file.read_text().startswith("Dear diary")


def test_a_missing_folder_is_refused_in_one_line(tmp_path):
    with pytest.raises(DatabaseMismatch, match="in a folder that exists"):
        prepare_file(tmp_path / "nowhere" / "study.sqlite")
