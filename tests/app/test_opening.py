"""Opening the database: its pool, its seed."""

import pytest
from sqlalchemy import update

from app.books import drawn_from
from app.errors import DatabaseMismatch, DatabaseUnavailable
from app.opening import open_database
from app.settings import Settings
from app.study import load_study
from app.tables import studies


def test_the_seed_is_stored_when_the_database_is_made_and_stays(settings, study):
    open_database(study).close()
    unseeded = settings.model_copy(update={"seed": None})
    database = open_database(load_study(unseeded))
    drawn = database.read_now(drawn_from)
    database.close()
    assert (drawn.seed, drawn.block_size) == (1, 4)


@pytest.mark.parametrize(("name", "value"), [("seed", 2), ("block_size", 8)])
def test_another_seed_or_block_size_than_the_stored_one_is_refused(settings, study, name, value):
    open_database(study).close()
    changed = Settings(**{**settings.model_dump(exclude_unset=True), name: value})
    with pytest.raises(DatabaseMismatch, match=f"GOALGUESS_{name.upper()}: expected"):
        open_database(load_study(changed))


def test_without_a_seed_one_is_drawn_at_random(tmp_path):
    seeds = set()
    for name in ("a", "b"):
        database = open_database(load_study(Settings(database_url=f"sqlite:///{tmp_path}/{name}")))
        seeds.add(database.read_now(drawn_from).seed)
        database.close()
    assert len(seeds) == 2


def test_each_definition_of_the_study_is_kept_with_its_hash(settings, study, database):
    slower = settings.model_copy(update={"step_ms": 2000})
    open_database(load_study(slower)).close()
    rows = database.read_now(lambda connection: connection.execute(studies.select()).all())
    assert {row.definition["step_ms"] for row in rows} == {1000, 2000}
    assert study.hash in {row.hash for row in rows}


def test_a_database_dealt_from_another_pool_is_refused(study):
    database = open_database(study)
    database.submit(lambda c: c.execute(update(studies).values(pool_hash="f" * 64))).result()
    database.close()
    with pytest.raises(DatabaseMismatch, match="found ffffffffffff"):
        open_database(study)


def test_no_new_study_is_begun_in_the_place_of_one_that_was_lost(settings, study):
    file = settings.database_file
    rescued = file.with_name(f"{file.name}.rescued-20260301T093000Z")
    file.rename(rescued)
    with pytest.raises(DatabaseUnavailable, match=f"goalguess restore {rescued}"):
        open_database(study)
    rescued.rename(file.with_name("elsewhere"))
    log = file.with_name(f"{file.name}-wal")
    log.write_bytes(b"answers")
    with pytest.raises(DatabaseUnavailable, match=r"its log .*-wal is there"):
        open_database(study)
    assert (log.read_bytes(), file.exists()) == (b"answers", False)
    log.unlink()
    open_database(study).close()


def test_a_lost_study_behind_a_link_is_missed_too(settings, study, tmp_path):
    file, real = settings.database_file, tmp_path / "real [1]"
    real.mkdir()
    rescued = real / "data.sqlite.rescued-20260301T093000Z"
    file.rename(rescued)
    file.symlink_to(real / "data.sqlite")
    with pytest.raises(DatabaseUnavailable, match="goalguess restore"):
        open_database(study)


def test_who_does_not_serve_a_study_registers_none(settings, study):
    open_database(study).close()
    slower = load_study(settings.model_copy(update={"step_ms": 2000}))
    database = open_database(slower, serving=False)
    kept = database.read_now(lambda connection: connection.execute(studies.select()).all())
    database.close()
    assert [row.hash for row in kept] == [study.hash]
