"""Texts that a spreadsheet would run: harmless in CSV, whole again for whoever reads it back."""

import csv

import polars as pl
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis import (
    EVENTS,
    PARTICIPANTS,
    TRIALS,
    code_book,
    read_dataset,
    read_table,
    spreadsheet_text,
    write_table,
)
from analysis.spreadsheet import as_spreadsheet_text, from_spreadsheet_text
from tests.analysis.rows import as_csv, event_row, participant_row, six_participants

TEXTS = st.lists(st.text(st.sampled_from("'=+-@\t\r\na1é")) | st.text(), max_size=20)


@given(TEXTS)
def test_every_text_is_given_back_whatever_it_begins_with(texts):
    column = pl.DataFrame({"text": texts}, schema={"text": pl.String()})
    written = column.select(as_spreadsheet_text(pl.col("text")))
    assert written.select(from_spreadsheet_text(pl.col("text"))).equals(column)


@given(TEXTS)
def test_a_text_alone_and_in_a_column_is_written_alike(texts):
    column = pl.DataFrame({"text": texts}, schema={"text": pl.String()})
    written = column.select(as_spreadsheet_text(pl.col("text")))
    assert written["text"].to_list() == [spreadsheet_text(text) for text in texts]


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("=1+1", "'=1+1"),
        ("'=1+1", "''=1+1"),
        ("-", "'-"),
        ("+351 555", "'+351 555"),
        ("@home", "'@home"),
        ("\tx", "'\tx"),
        ("\r\nx", "'\r\nx"),
        ("'s-Hertogenbosch", "'s-Hertogenbosch"),
        ("a=b", "a=b"),
        ("", ""),
    ],
)
def test_only_what_a_spreadsheet_would_run_gets_an_apostrophe(text, written):
    assert spreadsheet_text(text) == written


FORMULA = '=HYPERLINK("http://x","y")'


def test_no_cell_of_an_exported_csv_is_a_formula(tmp_path):
    row = participant_row("=P1", None, occupation=FORMULA, nationality="\t=1", gender="-x")
    paths = write_table(PARTICIPANTS, [row], tmp_path)
    with paths[0].open(encoding="utf-8", newline="") as file:
        cells = [cell for line in csv.reader(file) for cell in line]
    assert "'" + FORMULA in cells
    assert not [cell for cell in cells if cell[:1] in ("=", "+", "-", "@", "\t", "\r")]
    for path in paths:
        assert read_table(PARTICIPANTS, path).to_dicts() == [row]


def test_json_lines_and_parquet_hold_the_text_as_it_came(tmp_path):
    _, parquet, jsonl = write_table(EVENTS, [event_row(1, stimulus="=1")], tmp_path)
    assert pl.read_parquet(parquet)["stimulus"].to_list() == ["=1"]
    assert pl.read_ndjson(jsonl)["stimulus"].to_list() == ["=1"]


def test_a_table_from_elsewhere_keeps_its_apostrophes(tmp_path):
    rows = [
        {
            name: row[name]
            for name in ("participant", "condition", "scenario", "trial_index", "correct")
        }
        | {"stop_time_s": 5.0, "length_s": 20.0, "confidence": 5}
        | {"scenario": f"'=S{row['trial_index']}"}
        for row in six_participants()
    ]
    data = read_dataset(as_csv(tmp_path / "t.csv", rows))
    assert set(data.trials["scenario"]) == {"'=S1", "'=S2", "'=S3"}


def test_trials_of_our_own_export_lose_them(tmp_path):
    path = write_table(TRIALS, [row | {"maze": "=maze"} for row in six_participants()], tmp_path)[0]
    assert "'=maze" in path.read_text()
    assert set(read_dataset(path).trials["maze"]) == {"=maze"}


def test_the_code_book_says_what_the_apostrophe_means():
    assert "`'=1+1` stands for `=1+1`" in code_book()
