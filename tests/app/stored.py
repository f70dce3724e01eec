"""Databases with people in them, without pages: for tests of what is done with the files."""

import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

from app.database import Database
from app.sessions import participant_of
from app.study import PARTICIPANT, Study
from tests.app import people


def take_part(database: Database, study: Study, answers: int, stream: str = PARTICIPANT) -> str:
    """Let somebody answer that many trials; returns their session's token."""

    def write(happen: Callable[..., Any], *arguments: object) -> None:
        database.submit(lambda c: happen(c, study, token, *arguments)).result()

    token = database.submit(lambda c: people.reach_trials(c, study, stream)).result()
    for index in range(1, answers + 1):
        ticket = database.read_now(lambda c: people.ticket(c, study, token))
        write(people.play, ticket, index)
        write(people.stop, index, 1000)
        write(people.answer, index, 1000, "A", 4)
    return token


def pseudonym(database: Database, token: str) -> str:
    """The name under which somebody is known outside."""
    name: str = database.read_now(lambda c: participant_of(c, token).pseudonym)
    return name


def as_killed(file: Path, folder: Path) -> Path:
    """A copy of the files of a database in use, as a server leaves them that is killed."""
    folder.mkdir()
    for suffix in ("", "-wal", "-shm"):
        shutil.copy(f"{file}{suffix}", folder)
    return folder / file.name


def answers_in(file: Path) -> int:
    """How many answered trials SQLite finds in a database."""
    with closing(sqlite3.connect(file)) as connection:
        query = "SELECT count(*) FROM trials WHERE answered_at IS NOT NULL"
        count: int = connection.execute(query).fetchone()[0]
    return count


def contents(folder: Path) -> dict[str, bytes]:
    """Every file of a folder, but the log's index, which SQLite makes again."""
    files = (file for file in folder.iterdir() if file.is_file())
    return {file.name: file.read_bytes() for file in files if not file.name.endswith("-shm")}
