"""Who is to be paid: the recruiter's ids of participants, how they ended, and with which code."""

import csv
import os
from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields
from datetime import datetime
from io import StringIO
from pathlib import Path

from sqlalchemy import Connection

from analysis import spreadsheet_text
from app import books
from app.errors import InvalidInput
from app.study import PARTICIPANT, Study


@dataclass(frozen=True)
class Recruit:
    """A participant as the recruiter knows them; `code` is that of the ending they reached.

    The ids and both times (UTC) are texts, empty where there is none.
    """

    recruiter_id: str
    study_id: str
    session_id: str
    status: str
    code: str
    consented_at: str
    finished_at: str


NAMES = tuple(field.name for field in fields(Recruit))


def recruits(connection: Connection, study: Study) -> list[Recruit]:
    """All real participants with a recruiter's id, in the order in which they gave consent."""
    codes = {str(ending): code for ending, code in study.settings.codes.items()}
    return [
        Recruit(
            recruiter_id=row.recruiter_id,
            study_id=row.recruiter_study or "",
            session_id=row.recruiter_session or "",
            status=row.step,
            code=codes.get(row.step, ""),
            consented_at=_time(row.consented_at),
            finished_at=_time(row.finished_at),
        )
        for row in books.all_recruits(connection, PARTICIPANT)
    ]


def people_without_id(connection: Connection) -> str | None:
    """A line that counts the real participants who came without a recruiter's id, if any did."""
    count = books.count_without_id(connection, PARTICIPANT)
    if not count:
        return None
    people = "1 participant" if count == 1 else f"{count} participants"
    return f"{people} came without a recruiter's id: nobody can tell whom to pay for them."


def as_table(people: Sequence[Recruit]) -> str:
    """The recruits in columns for a terminal."""
    rows = [NAMES, *map(astuple, people)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    )


def as_csv(people: Sequence[Recruit]) -> str:
    """The recruits as CSV; a cell that a spreadsheet would calculate begins with an apostrophe."""
    text = StringIO()
    writer = csv.writer(text)
    writer.writerow(NAMES)
    writer.writerows([spreadsheet_text(cell) for cell in astuple(one)] for one in people)
    return text.getvalue()


def write_private(file: Path, text: str) -> None:
    """Write a file that only its owner can read, whole or not at all; InvalidInput if refused."""
    temporary = file.absolute().with_name(f".{file.name}.{os.getpid()}.tmp")
    try:
        descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        try:
            with os.fdopen(descriptor, "w", encoding="utf-8", newline="") as out:
                out.write(text)
            temporary.replace(file)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise
    except OSError as error:
        reason = error.strerror or str(error)
        raise InvalidInput(f"{file}: expected a file to write to, got: {reason}") from error


def _time(moment: datetime | None) -> str:
    return moment.strftime("%Y-%m-%dT%H:%M:%SZ") if moment else ""
