"""Tables that are larger than what is held of them: written in batches, whole or not at all."""

import weakref

import pytest

from analysis import EVENTS, PARTICIPANTS, TableError, read_table, tables, write_tables
from tests.analysis.rows import event_row, participant_row


@pytest.fixture
def small_batches(monkeypatch):
    monkeypatch.setattr(tables, "_BATCH", 3)


@pytest.mark.parametrize("count", [0, 1, 3, 7, 9])
def test_batches_leave_the_same_files_as_one_table(tmp_path, monkeypatch, count):
    rows = [event_row(number, stimulus=None if number < 5 else "=x") for number in range(count)]
    at_once = tables.write_table(EVENTS, rows, tmp_path / "at once")
    monkeypatch.setattr(tables, "_BATCH", 3)
    batched = tables.write_table(EVENTS, iter(rows), tmp_path / "batched")
    for one, other in zip(batched, at_once, strict=True):
        assert read_table(EVENTS, one).to_dicts() == rows
        if one.suffix != ".parquet":
            assert one.read_bytes() == other.read_bytes()


class Row(dict[str, object]):
    """A row of which one can tell whether somebody still holds it."""


@pytest.mark.usefixtures("small_batches")
def test_no_more_rows_are_held_than_two_batches(tmp_path):
    made, most_held = [], 0

    def rows():
        nonlocal most_held
        for number in range(60):
            row = Row(event_row(number))
            made.append(weakref.ref(row))
            most_held = max(most_held, sum(each() is not None for each in made))
            yield row

    tables.write_table(EVENTS, rows(), tmp_path)
    assert 3 <= most_held <= 6


@pytest.mark.usefixtures("small_batches")
def test_a_row_that_is_refused_is_named_by_its_place_in_the_whole_table(tmp_path):
    rows = [*map(event_row, range(7)), event_row(7, prolific_pid="x")]
    with pytest.raises(TableError, match=r"row 8: .*prolific_pid unknown"):
        tables.write_table(EVENTS, rows, tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("small_batches")
def test_several_tables_appear_together_or_not_at_all(tmp_path):
    old = [(EVENTS, [event_row(1)]), (PARTICIPANTS, [participant_row("P1", None)])]
    write_tables(old, tmp_path)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    def broken_off():
        yield from (participant_row(f"P{number}", None) for number in range(5))
        raise RuntimeError("the database is gone")

    new = [(EVENTS, [event_row(1), event_row(2)]), (PARTICIPANTS, broken_off())]
    with pytest.raises(RuntimeError, match="gone"):
        write_tables(new, tmp_path)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
