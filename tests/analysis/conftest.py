"""Data sets made for the tests, through the same door the app uses."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from analysis import EVENTS, PARTICIPANTS, TRIALS, Results, analyse_path, write_report, write_table
from analysis.plan import Plan, read_plan
from tests.analysis.rows import HERE, event_row, participants_of, six_participants


@pytest.fixture(scope="session")
def paper_fixture() -> Path:
    """Synthetic trials made to reproduce the numbers that the paper prints.

    They are not the authors' data, which are not published.
    """
    return HERE / "paper_fixture.csv"


@pytest.fixture(scope="session")
def paper(paper_fixture: Path) -> Results:
    """Everything the analysis says of the synthetic trials."""
    return analyse_path(paper_fixture)


@pytest.fixture(scope="session")
def written(paper: Results, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder with the report on the synthetic trials, all figures drawn."""
    folder = tmp_path_factory.mktemp("reports") / "report"
    write_report(paper, folder, lambda _what: None)
    return folder


@pytest.fixture
def export(tmp_path: Path) -> Path:
    """An export folder of six participants."""
    folder = tmp_path / "export"
    rows = six_participants()
    write_table(TRIALS, rows, folder)
    write_table(PARTICIPANTS, participants_of(rows), folder)
    write_table(EVENTS, [event_row(1)], folder)
    return folder


@pytest.fixture
def plan_of(tmp_path: Path) -> Callable[[str], Plan]:
    """Read a plan from its text."""

    def read(text: str) -> Plan:
        path = tmp_path / "mine.toml"
        path.write_text(text)
        return read_plan(path)

    return read


@pytest.fixture(scope="session")
def golden() -> Callable[[str], dict[str, Any]]:
    """Look up a case of golden.json by id: input, expected numbers, their source, tolerance."""
    cases = json.loads((HERE / "golden.json").read_text())
    return {case["id"]: case for case in cases}.__getitem__
