"""Opening the database of a study: its schema, its pool and seed, those who withdrew."""

import secrets

from sqlalchemy import Connection

from app import books, enrolment
from app.database import Database
from app.errors import DatabaseMismatch
from app.schema import prepare
from app.study import Study


def open_database(study: Study) -> Database:
    """The database of a study's settings, up to date; DatabaseMismatch if it is not ours."""
    settings = study.settings
    file = settings.database_file
    prepare(settings.database_url, str(file))
    database = Database(settings.database_url)
    try:
        database.submit(lambda c: _open_books(c, study)).result()
        database.submit(lambda c: enrolment.withdraw_again(c, study)).result()
    except BaseException:
        database.close()
        raise
    return database


def _open_books(connection: Connection, study: Study) -> None:
    """Note the study's definition; DatabaseMismatch if the places come from another pool."""
    found = books.pool_in_use(connection)
    if found not in (None, study.pool.hash):
        raise DatabaseMismatch(
            f"expected a database dealt from stimulus pool {study.pool.hash[:12]}, found "
            f"{found[:12] if found else found}; name a new file in GOALGUESS_DATABASE_URL"
        )
    books.register_study(connection, study.hash, study.definition, study.pool.hash)
    settings = study.settings
    seed = secrets.randbits(32) if settings.seed is None else settings.seed
    books.draw_from(connection, seed, settings.block_size)
    drawn = books.drawn_from(connection)
    for name, kept in (("seed", drawn.seed), ("block_size", drawn.block_size)):
        wanted = getattr(settings, name)
        if name in settings.model_fields_set and wanted not in (None, kept):
            raise DatabaseMismatch(
                f"GOALGUESS_{name.upper()}: expected {kept}, with which this database was begun, "
                f"came {wanted}; leave it out, or name a new file in GOALGUESS_DATABASE_URL"
            )
