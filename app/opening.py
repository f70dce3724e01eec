"""Opening the database of a study: its schema, its pool and seed, those who withdrew."""

import glob
import secrets
from pathlib import Path

from sqlalchemy import Connection

from app import books, enrolment
from app.database import Database
from app.database_files import LOG, RESCUED, append_privately, beside, files_of, open_to_others
from app.errors import DatabaseMismatch, DatabaseUnavailable
from app.schema import prepare
from app.sqlite import damage
from app.study import PARTICIPANT, Study


def open_database(study: Study, serving: bool = True) -> Database:
    """The database of a study's settings, up to date; DatabaseMismatch if it is not ours.

    Only who serves it notes the study's definition there.
    """
    settings = study.settings
    file = settings.database_file
    _expect_no_remains(file)
    _expect_sound(file)
    prepare(settings.database_url, str(file))
    database = Database(settings.database_url)
    try:
        database.submit(lambda c: _open_books(c, study, serving)).result()
        database.submit(lambda c: enrolment.withdraw_again(c, study)).result()
        # Whether a withdrawal can be noted is known before somebody withdraws.
        append_privately(settings.withdrawals_file).close()
    except BaseException:
        database.close()
        raise
    return database


def holdings(connection: Connection) -> str:
    """How many participants and answers a database holds, in words; pilots apart."""
    people = books.count_participants(connection)
    real = people.pop(PARTICIPANT, 0)
    pilots = sum(people.values())
    answers = books.count_answers(connection, PARTICIPANT)
    words = f"{_number(real, 'participant')} and {_number(answers, 'answer')}"
    return words + (f" ({_number(pilots, 'pilot')} apart)" if pilots else "")


def start_line(study: Study, is_new: bool, database: Database) -> str:
    """Where answers go, and what is there already, for who starts the server."""
    file = study.settings.database_file.absolute()
    if is_new:
        return f"Answers go to {file}, a new file: nobody has taken part yet."
    return f"Answers go to {file}, which holds {database.read_now(holdings)}."


def start_warnings(study: Study) -> list[str]:
    """What about the database's files is not as it should be, a line each."""
    settings = study.settings
    files = [*files_of(settings.database_file.absolute()), settings.withdrawals_file.absolute()]
    readable = open_to_others(files)
    names = " ".join(map(str, readable))
    warning = "Other users of this machine may read the database: chmod 600"
    return [f"{warning} {names}"] if readable else []


def expect_pool(connection: Connection, study: Study) -> None:
    """DatabaseMismatch if the places come from another pool."""
    found = books.pool_in_use(connection)
    if found not in (None, study.pool.hash):
        raise DatabaseMismatch(
            f"expected a database dealt from stimulus pool {study.pool.hash[:12]}, found "
            f"{found[:12] if found else found}; name a new file in GOALGUESS_DATABASE_URL"
        )


def _number(count: int, what: str) -> str:
    return f"{count:,} {what}" + ("" if count == 1 else "s")


def _expect_no_remains(file: Path) -> None:
    """DatabaseUnavailable rather than a new database in the place of one that was lost."""
    if file.exists() and file.stat().st_size:
        return
    real = beside(file, "")
    rescued = sorted(real.parent.glob(f"{glob.escape(real.name)}.{RESCUED}-*"))
    if rescued:
        raise DatabaseUnavailable(
            f"{file}: it is gone, but what was in it is in {rescued[-1]}; goalguess restore "
            f"{rescued[-1]} puts it back, or move that away to begin anew"
        )
    log = beside(file, LOG)
    if log.exists() and log.stat().st_size:
        raise DatabaseUnavailable(
            f"{file}: it is gone, but its log {log} is there; put the file back, or move the log "
            "away to begin anew"
        )


def _expect_sound(file: Path) -> None:
    found = damage(file) if file.is_file() and file.stat().st_size else None
    if found:
        log = f", or {LOG} beside it belongs to another file" if beside(file, LOG).exists() else ""
        raise DatabaseUnavailable(
            f"{file}: it is damaged{log} ({found}); goalguess restore puts a backup in its place"
        )


def _open_books(connection: Connection, study: Study, serving: bool) -> None:
    """Note the study's definition; DatabaseMismatch if the database was begun otherwise."""
    expect_pool(connection, study)
    if not serving:
        return
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
