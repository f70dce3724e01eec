"""The export: all tables, the code book and what the study's hashes stand for, as files."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import Connection

from analysis import EVENTS, PARTICIPANTS, TABLES, TRIALS, Table, code_book, write_tables
from app import books
from app.database import Database
from app.export_rows import Derivation, Person, Row, event_row, people
from app.study import PARTICIPANT, Study


@dataclass(frozen=True)
class Exported:
    """How many rows of each table were written, and how many pilots were left out."""

    rows: dict[str, int]
    pilots_left_out: int


def export(database: Database, study: Study, folder: Path, simulated: bool) -> Exported:
    """Write the three tables, the code book, and what the study's hashes stand for.

    Rows of simulated and preview participants are written only if asked for. All files show
    the database at one moment, also while the study runs; no table is held in memory.
    """
    counts = dict.fromkeys((table.name for table in TABLES), 0)

    def counted(table: Table, rows: Iterator[Row]) -> Iterator[Row]:
        for row in rows:
            counts[table.name] += 1
            yield row

    def write(connection: Connection) -> Exported:
        rows = _rows(connection, study, simulated)
        write_tables(((table, counted(table, rows[table.name])) for table in TABLES), folder)
        about = {"counts": books.all_tallies(connection), "studies": books.all_studies(connection)}
        (folder / "codebook.md").write_text(code_book(), encoding="utf-8")
        text = json.dumps(about, indent=2, sort_keys=True, ensure_ascii=False)
        (folder / "study.json").write_text(f"{text}\n", encoding="utf-8")
        streams = books.count_by_stream(connection)
        pilots = sum(count for stream, count in streams.items() if stream != PARTICIPANT)
        return Exported(counts, 0 if simulated else pilots)

    return database.read_now(write)


def _rows(connection: Connection, study: Study, simulated: bool) -> dict[str, Iterator[Row]]:
    """The rows of each table, made as they are asked for."""
    derive = Derivation(study)

    def wanted(stream: str) -> bool:
        return simulated or stream == PARTICIPANT

    def wanted_people() -> Iterator[Person]:
        return (person for person in people(connection) if wanted(person.record.stream))

    return {
        TRIALS.name: (trial for person in wanted_people() for trial in derive.trials(person)),
        PARTICIPANTS.name: (derive.participant(person) for person in wanted_people()),
        EVENTS.name: (
            event_row(study, event)
            for event in books.all_events(connection)
            if wanted(event.stream)
        ),
    }
