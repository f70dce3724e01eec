"""Acknowledged answers survive a power cut, on the model of a disk that forgets the unsynced."""

from functools import partial

import numpy as np
import pytest

from tests.app.power_cut import SECTOR, Disk, before_syncs, cut_power
from tests.app.recorded_answers import record_answers
from tests.app.recorded_sqlite import (
    Deleted,
    HiddenSqlite,
    Synced,
    Truncated,
    Wrote,
    sqlite_library,
)

VISITORS = 24
ANSWERS = 200
"""Of 24 visitors four withdraw; the others answer ten trials each."""


@pytest.fixture(scope="module")
def record():
    """Records a study in which people answer; skips where SQLite hides what it does."""
    try:
        sqlite_library()
    except HiddenSqlite as reason:
        pytest.skip(f"no power cuts here: {reason}")
    return partial(record_answers, visitors=VISITORS)


@pytest.fixture(scope="module")
def journal(record, tmp_path_factory):
    """What happens in the study as it is served."""
    return record(tmp_path_factory.mktemp("study"))


def test_every_acknowledged_answer_is_in_what_was_synced_at_any_moment(journal, tmp_path):
    cuts = cut_power(journal, before_syncs(journal), tmp_path / "left")
    assert cuts.acknowledged == ANSWERS
    assert (cuts.lost, cuts.double, cuts.damaged) == (0, 0, 0)


def test_parts_of_what_was_not_synced_harm_no_acknowledged_answer(journal, tmp_path):
    chance = np.random.default_rng(1)
    at = set(chance.choice(len(journal), 300, replace=False).tolist())
    cuts = cut_power(journal, at, tmp_path / "left", chance)
    assert (cuts.lost, cuts.double, cuts.damaged) == (0, 0, 0)


def test_answers_would_be_lost_if_each_commit_were_not_synced(record, tmp_path):
    journal = record(tmp_path, synchronous="NORMAL")
    cuts = cut_power(journal, before_syncs(journal), tmp_path / "left")
    assert cuts.acknowledged == ANSWERS
    assert cuts.lost > 0


def disk_after(*entries):
    disk = Disk()
    for entry in entries:
        disk.take(entry)
    return disk


def test_only_what_was_synced_is_left_for_sure():
    disk = disk_after(
        Wrote("a", 0, b"old"), Synced("a"), Wrote("a", 2, b"new"), Wrote("b", 0, b"x")
    )
    assert disk.left() == {"a": b"old"}
    disk.take(Synced("a"))
    assert disk.left() == {"a": b"olnew"}


def test_a_hole_before_what_was_written_is_zeros_and_a_truncation_cuts():
    disk = disk_after(Wrote("a", 2, b"xyz"), Truncated("a", 4), Synced("a"))
    assert disk.left() == {"a": b"\0\0xy"}


def test_what_was_not_synced_survives_in_whole_sectors():
    disk = disk_after(Wrote("a", 0, bytes(3 * SECTOR)), Synced("a"), Wrote("a", 100, b"x" * 1000))
    chance = np.random.default_rng(1)
    left = {bytes(disk.left(chance)["a"]) for _ in range(200)}
    parts = (SECTOR - 100, SECTOR, 1100 - 2 * SECTOR)
    assert {content.count(b"x") for content in left} == {
        sum(part for part, kept in zip(parts, bits, strict=True) if kept)
        for bits in np.ndindex(2, 2, 2)
    }


def test_a_deletion_is_on_disk_with_the_first_sync_of_a_new_file():
    disk = disk_after(Wrote("a", 0, b"x"), Synced("a"), Deleted("a"))
    assert disk.left() == {"a": b"x"}
    disk.take(Wrote("a", 0, b"unsynced"))
    disk.take(Wrote("b", 0, b"y"))
    disk.take(Synced("b"))
    assert disk.left() == {"b": b"y"}
