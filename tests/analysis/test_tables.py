"""Writing a table and reading it back: three formats, one content, never half a file."""

import json
from datetime import UTC, datetime, timedelta, timezone

import polars as pl
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from polars.testing import assert_frame_equal

from analysis import (
    EVENTS,
    PARTICIPANTS,
    TABLES,
    TRIALS,
    AnalysisError,
    Kind,
    TableError,
    read_table,
    write_table,
)
from tests.analysis.rows import START, edited, event_row, participant_row, trial_row

ONE_ROW = {
    "trials": trial_row("P1", 1, "polmdp"),
    "participants": participant_row("P1", None),
    "events": event_row(1),
}

LETTERS = st.characters(codec="utf-8", exclude_categories=["Cs"], exclude_characters="\0")
WORDS = st.builds(
    "".join, st.tuples(st.text("'=+-@\t\r", max_size=2), st.text(LETTERS, min_size=1, max_size=20))
)


def cells(column):
    """Values that the column's declaration allows."""
    low = 0 if column.low is None else column.low
    high = 1_000_000 if column.high is None else column.high
    values = {
        Kind.TEXT: st.sampled_from(column.choices or ("B",))
        if column.choices or column.letter
        else WORDS,
        Kind.JSON: st.dictionaries(WORDS, st.integers() | WORDS, max_size=3).map(json.dumps),
        Kind.INTEGER: st.integers(int(low), int(high)),
        Kind.NUMBER: st.floats(low, high, exclude_min=column.above is not None),
        Kind.BOOLEAN: st.booleans(),
        Kind.TIME: st.datetimes(datetime(1990, 1, 1), datetime(2200, 1, 1), timezones=st.just(UTC)),
    }[column.kind]
    return st.none() | values if column.nullable else values


def rows_of(table):
    row = st.fixed_dictionaries({column.name: cells(column) for column in table.columns})
    return st.lists(row, max_size=4, unique_by=lambda row: tuple(row[name] for name in table.key))


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.name)
def test_every_format_gives_back_what_was_written(table, tmp_path_factory):
    @settings(max_examples=15, deadline=None, suppress_health_check=list(HealthCheck))
    @given(rows_of(table))
    def round_trip(rows):
        folder = tmp_path_factory.mktemp("round")
        for path in write_table(table, rows, folder):
            frame = read_table(table, path)
            assert frame.to_dicts() == rows
            assert dict(frame.schema) == table.schema

    round_trip()


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.name)
def test_a_table_without_rows_keeps_its_columns_in_every_format(table, tmp_path):
    for path in write_table(table, [], tmp_path):
        frame = read_table(table, path)
        assert frame.is_empty()
        assert dict(frame.schema) == table.schema


def test_an_empty_text_is_a_missing_value_in_every_format(tmp_path):
    row = participant_row("P1", None, nationality="")
    for path in write_table(PARTICIPANTS, [row], tmp_path):
        assert read_table(PARTICIPANTS, path)["nationality"].to_list() == [None]
    assert pl.read_parquet(tmp_path / "participants.parquet")["nationality"].to_list() == [None]


def test_text_that_looks_like_a_table_survives(tmp_path):
    nasty = 'a,b\n"c";\t=1+1 Ünï\\|'
    for path in write_table(PARTICIPANTS, [participant_row("P1", None, gender=nasty)], tmp_path):
        assert read_table(PARTICIPANTS, path)["gender"].item() == nasty


def test_csv_times_are_iso_8601_in_utc(tmp_path):
    lisbon_summer = timezone(timedelta(hours=1))
    row = event_row(1, server_time=datetime(2025, 7, 1, 10, 0, 0, 42, tzinfo=lisbon_summer))
    write_table(EVENTS, [row], tmp_path)
    assert "2025-07-01T09:00:00.000042Z" in (tmp_path / "events.csv").read_text()
    assert "2025-07-01T09:00:00.000042Z" in (tmp_path / "events.jsonl").read_text()


def test_json_lines_hold_one_object_per_row_with_json_types(tmp_path):
    write_table(TRIALS, [trial_row("P1", index, "polmdp") for index in (1, 2)], tmp_path)
    lines = (tmp_path / "trials.jsonl").read_text().splitlines()
    first = json.loads(lines[0])
    assert len(lines) == 2
    assert first["correct"] is True
    assert first["stop_time_s"] == 9.25
    assert list(first) == list(TRIALS.names)


def test_numbers_keep_every_digit(tmp_path):
    for path in write_table(
        TRIALS, [trial_row("P1", 1, "polmdp", stop_time_s=0.1 + 0.2)], tmp_path
    ):
        assert read_table(TRIALS, path)["stop_time_s"].item() == 0.1 + 0.2


def test_the_three_paths_are_returned_and_nothing_else_is_left(tmp_path):
    paths = write_table(EVENTS, [event_row(1)], tmp_path / "new" / "folder")
    assert sorted(path.name for path in paths) == ["events.csv", "events.jsonl", "events.parquet"]
    assert sorted((tmp_path / "new" / "folder").iterdir()) == sorted(paths)


def test_a_failing_write_leaves_the_older_files_whole(tmp_path, monkeypatch):
    write_table(EVENTS, [event_row(1)], tmp_path)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    def disk_full(*_args, **_kwargs):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(pl.DataFrame, "write_ndjson", disk_full)
    with pytest.raises(AnalysisError, match="No space left"):
        write_table(EVENTS, [event_row(1), event_row(2)], tmp_path)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_row_without_one_of_the_columns_is_refused(tmp_path):
    row = event_row(1)
    del row["details"]
    with pytest.raises(TableError, match=r"events, row 1: .*details missing"):
        write_table(EVENTS, [row], tmp_path)


def test_a_row_with_an_unknown_column_is_refused(tmp_path):
    with pytest.raises(TableError, match=r"row 2: .*prolific_pid unknown"):
        write_table(EVENTS, [event_row(1), event_row(2, prolific_pid="x")], tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_value_of_another_type_is_refused(tmp_path):
    with pytest.raises(TableError, match="column trial_index: expected whole number"):
        write_table(EVENTS, [event_row(1, trial_index="three")], tmp_path)


def test_a_time_without_a_zone_is_refused(tmp_path):
    naive = START.replace(tzinfo=None)
    with pytest.raises(TableError, match=r"column server_time: .*no time with a zone"):
        write_table(EVENTS, [event_row(1, server_time=naive)], tmp_path)


def test_a_file_in_the_way_of_the_folder_is_one_clear_error(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(AnalysisError, match="expected a folder to write to"):
        write_table(EVENTS, [], tmp_path / "file")


def test_what_a_spreadsheet_makes_of_true_and_7_is_understood(tmp_path):
    path = write_table(TRIALS, [trial_row("P1", 1, "polmdp")], tmp_path)[0]
    edited(path, 2, "correct", "TRUE")
    edited(path, 2, "confidence", "7.0")
    edited(path, 2, "length_s", "20")
    frame = read_table(TRIALS, path)
    assert frame.row(0, named=True)["correct"] is True
    assert frame["confidence"].item() == 7


def test_a_byte_order_mark_is_no_part_of_the_first_name(tmp_path):
    path = write_table(EVENTS, [event_row(1)], tmp_path)[0]
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert read_table(EVENTS, path)["event_id"].to_list() == [1]


def test_columns_may_come_in_any_order_and_with_others(tmp_path):
    path = write_table(EVENTS, [event_row(1), event_row(2)], tmp_path)[0]
    frame = pl.read_csv(path, infer_schema=False)
    frame.with_columns(note=pl.lit("mine")).select(reversed([*frame.columns, "note"])).write_csv(
        tmp_path / "shuffled.csv"
    )
    assert_frame_equal(read_table(EVENTS, tmp_path / "shuffled.csv"), read_table(EVENTS, path))


@pytest.mark.parametrize(
    ("column", "text", "complaint"),
    [
        ("event_id", "1.5", "column event_id: expected whole number 0 or more, got '1.5'"),
        ("event_id", "-1", "column event_id: expected whole number 0 or more, got -1"),
        ("event_id", "", "column event_id: expected whole number 0 or more, got nothing"),
        ("client_time_ms", "nan", "column client_time_ms: expected number 0 or more, got 'nan'"),
        ("client_time_ms", "1e999", "column client_time_ms: .*, got '1e999'"),
        ("server_time", "yesterday", "column server_time: expected UTC time, got 'yesterday'"),
        ("server_time", "2025-03-01T09:30:00", "column server_time: expected UTC time"),
        ("details", "{why", "column details: expected JSON text, got '{why'"),
        ("participant", "", "column participant: expected text, got nothing"),
    ],
)
def test_a_cell_that_breaks_the_contract_is_named_by_row_and_column(
    tmp_path, column, text, complaint
):
    rows = [event_row(number, details="{}") for number in (1, 2, 3)]
    path = write_table(EVENTS, rows, tmp_path)[0]
    edited(path, 3, column, text)
    with pytest.raises(TableError, match=f"^events.csv, row 3, {complaint}") as caught:
        read_table(EVENTS, path)
    assert (caught.value.row, caught.value.column, caught.value.further) == (3, column, 0)


def test_rows_of_json_lines_count_from_the_first_line(tmp_path):
    path = write_table(EVENTS, [event_row(1), event_row(-2)], tmp_path)[2]
    with pytest.raises(TableError, match=r"events.jsonl, row 2, column event_id"):
        read_table(EVENTS, path)


def test_parquet_rows_count_as_those_of_the_same_csv(tmp_path):
    _, parquet, _ = write_table(EVENTS, [event_row(1), event_row(-2)], tmp_path)
    with pytest.raises(TableError, match=r"events.parquet, row 3, column event_id"):
        read_table(EVENTS, parquet)


def test_a_parquet_file_with_narrower_types_is_converted(tmp_path):
    _, parquet, _ = write_table(EVENTS, [event_row(1)], tmp_path)
    narrow = pl.read_parquet(parquet).with_columns(
        pl.col("event_id").cast(pl.Int16), pl.col("server_time").dt.cast_time_unit("ms")
    )
    narrow.write_parquet(tmp_path / "narrow.parquet")
    assert_frame_equal(read_table(EVENTS, tmp_path / "narrow.parquet"), read_table(EVENTS, parquet))


def test_the_same_row_twice_is_named_with_its_key(tmp_path):
    path = write_table(EVENTS, [event_row(4), event_row(5), event_row(4)], tmp_path)[0]
    with pytest.raises(TableError, match=r"row 4, column event_id: .*once, got event_id 4"):
        read_table(EVENTS, path)


def test_further_problems_are_counted_and_the_first_row_is_named(tmp_path):
    path = write_table(EVENTS, [event_row(number) for number in range(1, 6)], tmp_path)[0]
    edited(path, 5, "client_time_ms", "-3")
    edited(path, 3, "client_time_ms", "soon")
    edited(path, 6, "server_time", "")
    with pytest.raises(TableError, match=r"row 3, .*\(and 2 more problems\)$") as caught:
        read_table(EVENTS, path)
    assert caught.value.further == 2


def test_missing_columns_are_listed(tmp_path):
    path = tmp_path / "events.csv"
    path.write_text("participant,event_id\nP1,1\n")
    with pytest.raises(TableError, match=r"events.csv, row 1: expected columns trial_index, type"):
        read_table(EVENTS, path)


@pytest.mark.parametrize(
    ("name", "content", "complaint"),
    [
        ("a.csv", b"", "row 1: expected a header of different column names, got an empty file"),
        ("a.csv", b"x,y,x\n1,2,3\n", "row 1: .*got x more than once"),
        ("a.csv", b"participant\n\xff\xfe\n", "in UTF-8"),
        ("a.jsonl", b"[1]\n", "row 1: expected a JSON object"),
        ("a.parquet", b"not parquet", "expected a readable .parquet file"),
        ("a.xlsx", b"", "expected a file ending in .csv, .parquet, .jsonl, got .xlsx"),
    ],
)
def test_a_file_that_is_no_table_is_one_clear_error(tmp_path, name, content, complaint):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(AnalysisError, match=complaint) as caught:
        read_table(EVENTS, tmp_path / name)
    assert "\n" not in str(caught.value)


def test_a_row_with_too_many_cells_is_named(tmp_path):
    path = write_table(EVENTS, [event_row(1), event_row(2)], tmp_path)[0]
    path.write_text(path.read_text().rstrip("\n") + ",surplus\n")
    with pytest.raises(TableError, match="row 3: expected 10 cells as in the header, got 11"):
        read_table(EVENTS, path)


def test_a_line_that_is_cut_off_is_named(tmp_path):
    path = write_table(EVENTS, [event_row(1), event_row(2)], tmp_path)[2]
    path.write_text(path.read_text()[:-20])
    with pytest.raises(TableError, match="row 2: expected one JSON object"):
        read_table(EVENTS, path)


def test_a_file_that_is_not_there_is_one_clear_error(tmp_path):
    with pytest.raises(AnalysisError, match="expected a file, got nothing"):
        read_table(EVENTS, tmp_path / "events.csv")


def test_every_table_accepts_its_example_row(tmp_path):
    for table in TABLES:
        assert read_table(table, write_table(table, [ONE_ROW[table.name]], tmp_path)[0]).height == 1
