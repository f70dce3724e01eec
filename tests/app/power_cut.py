"""A power cut at any moment: what SQLite had not synced is gone, or there in parts.

A journal of answers (`recorded_answers`) is replayed up to a cut, on a model of a disk. What was
synced by then is kept. Of the rest either nothing is kept, or each sector of 512 bytes survives by
chance, as do truncations and deletions. SQLite is then opened on what is left, and asked for the
answers that had been acknowledged before the cut.
"""

import shutil
import sqlite3
from collections import Counter, defaultdict
from collections.abc import Iterator, Set
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tests.app.recorded_answers import FILE, Acknowledged, Journal
from tests.app.recorded_sqlite import Change, Deleted, Entry, Synced, Truncated, Wrote

SECTOR = 512
_ANSWERS = """
    SELECT participant_id, trial_index, stop_time_ms, guess, confidence
    FROM trials WHERE answered_at IS NOT NULL
"""
_LOGGED = "SELECT participant_id, trial_index FROM events WHERE type = 'answered'"

Files = dict[str, bytearray]


@dataclass(frozen=True)
class PowerCuts:
    """How many cuts were tried, and what became of the answers acknowledged before them."""

    cuts: int
    acknowledged: int
    lost: int
    double: int
    damaged: int


def before_syncs(journal: Journal) -> set[int]:
    """The cuts to try when only what was synced is kept, as good as all of them.

    From one sync to the next the same is kept, and acknowledged answers only become more.
    """
    return {i for i, entry in enumerate(journal) if isinstance(entry, Synced)} | {len(journal)}


def cut_power(
    journal: Journal, cuts: Set[int], folder: Path, chance: np.random.Generator | None = None
) -> PowerCuts:
    """Cut the power before each of these entries; with chance, parts of the unsynced survive."""
    disk = Disk()
    told: set[Acknowledged] = set()
    found = []
    for position, entry in enumerate([*journal, None]):
        if position in cuts:
            found.append(_inspect(disk.left(chance), told, folder))
        if isinstance(entry, Acknowledged):
            told.add(entry)
        elif entry is not None:
            disk.take(entry)
    return PowerCuts(
        cuts=len(found),
        acknowledged=len(told),
        lost=len(set().union(*(left.lost for left in found))),
        double=len(set().union(*(left.double for left in found))),
        damaged=sum(left.damaged for left in found),
    )


class _Left(NamedTuple):
    lost: Set[Acknowledged]
    double: Set[tuple[int, int]]
    damaged: bool


def _inspect(files: Files, told: Set[Acknowledged], folder: Path) -> _Left:
    """Compare what SQLite makes of the files with what participants were told."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for name, content in files.items():
        (folder / name).write_bytes(content)
    with closing(sqlite3.connect(folder / FILE)) as connection:
        try:
            damaged = connection.execute("PRAGMA integrity_check").fetchone() != ("ok",)
            if not told:
                # So early there may be no tables yet.
                return _Left(set(), set(), damaged)
            answers = connection.execute(_ANSWERS).fetchall()
            logged = connection.execute(_LOGGED).fetchall()
        except sqlite3.DatabaseError:
            return _Left(told, set(), damaged=True)
    stored = Counter((who, trial_index) for who, trial_index, *_ in answers)
    double = {trial for trial, times in (stored | Counter(logged)).items() if times > 1}
    return _Left(told - set(answers), double, damaged)


class Disk:
    """Files as they are on a disk for sure, and the changes that are not there yet."""

    def __init__(self) -> None:
        self.files: Files = {}
        self.waiting: dict[str, list[Change]] = defaultdict(list)

    def take(self, entry: Entry) -> None:
        """A change to a file, or the sync that brings its changes to the disk."""
        if not isinstance(entry, Synced):
            self.waiting[entry.file].append(entry)
            return
        if entry.file not in self.files:
            # With the first sync of a new journal or log, SQLite syncs the folder.
            for file in list(self.waiting):
                self._settle(file, self._deletions(file))
        self._settle(entry.file, len(self.waiting[entry.file]))

    def left(self, chance: np.random.Generator | None = None) -> Files:
        """The files after a power cut now; with chance, parts of what was not synced survive."""
        files = {name: content.copy() for name, content in self.files.items()}
        if chance is not None:
            share = chance.random()
            for changes in self.waiting.values():
                for part in (part for change in changes for part in _parts(change)):
                    if chance.random() < share:
                        _apply(part, files)
        return files

    def _deletions(self, file: str) -> int:
        """How many of a file's changes there are up to its last deletion."""
        changes = enumerate(self.waiting[file], start=1)
        return max((n for n, change in changes if isinstance(change, Deleted)), default=0)

    def _settle(self, file: str, number: int) -> None:
        for change in self.waiting[file][:number]:
            _apply(change, self.files)
        del self.waiting[file][:number]


def _apply(change: Change, files: Files) -> None:
    content = files.setdefault(change.file, bytearray())
    match change:
        case Wrote(_, offset, data):
            content.extend(bytes(max(0, offset - len(content))))
            content[offset : offset + len(data)] = data
        case Truncated(_, size):
            del content[size:]
        case Deleted():
            del files[change.file]


def _parts(change: Change) -> Iterator[Change]:
    """What of a change survives or not as a whole."""
    if not isinstance(change, Wrote):
        yield change
        return
    begin, end = change.offset, change.offset + len(change.data)
    for border in range(begin - begin % SECTOR, end, SECTOR):
        first, last = max(border, begin), min(border + SECTOR, end)
        yield Wrote(change.file, first, change.data[first - begin : last - begin])
