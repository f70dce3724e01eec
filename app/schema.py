"""Making and upgrading the schema, and refusing databases that are not ours to open."""

from pathlib import Path

from sqlalchemy import URL, Connection, inspect, text

from app.database_files import make_private
from app.errors import DatabaseMismatch
from app.sqlite import file_of, refusals, sqlite_engine, url_of

HEAD = "0003"
"""Revision that this version works with; a test holds it equal to the newest migration."""


def prepare(url: str | URL, name: str) -> None:
    """Bring a database up to date; DatabaseMismatch, and nothing touched, if it can't be ours."""
    make_private(file_of(url))
    engine = sqlite_engine(url, begin="BEGIN IMMEDIATE")
    try:
        with refusals(name), engine.connect() as connection, connection.begin():
            found = _revision(connection, name)
            if found != HEAD:
                _upgrade(connection, found, name)
    finally:
        engine.dispose()


def expect_ours(file: Path, name: str) -> None:
    """DatabaseMismatch unless some version of Goalguess has made the database."""
    engine = sqlite_engine(url_of(file), begin="BEGIN")
    with refusals(name), engine.connect() as connection, connection.begin():
        if _revision(connection, name) is None:
            raise DatabaseMismatch(f"{name}: expected a database with answers, found an empty one")


def _revision(connection: Connection, name: str) -> str | None:
    tables = inspect(connection).get_table_names()
    if not tables:
        return None
    if "alembic_version" not in tables:
        raise DatabaseMismatch(
            f"{name}: expected a Goalguess database or no file, found tables of another program"
        )
    found: str | None = connection.scalar(text("SELECT version_num FROM alembic_version"))
    return found


def _upgrade(connection: Connection, found: str | None, name: str) -> None:
    # Loaded late: a server that finds its database up to date never pays for it.
    from alembic import command
    from alembic.config import Config
    from alembic.script import ScriptDirectory

    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent / "migrations"))
    known = {script.revision for script in ScriptDirectory.from_config(config).walk_revisions()}
    if found is not None and found not in known:
        raise DatabaseMismatch(
            f"{name}: expected a database of version {HEAD} or older, found version {found!r}; "
            "open it with the version of Goalguess that made it, or name a new file in "
            "GOALGUESS_DATABASE_URL"
        )
    config.attributes["connection"] = connection
    command.upgrade(config, HEAD)
