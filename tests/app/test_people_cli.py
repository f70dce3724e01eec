"""`goalguess recruits` and `goalguess withdraw`: who is to be paid, and who asks to be deleted."""

import csv
import io
import json
import sqlite3
import stat

import httpx2
import pytest
from sqlalchemy import select, update
from starlette.testclient import TestClient
from typer.testing import CliRunner

from app.cli import commands
from app.errors import AppError
from app.main import create_app
from app.opening import open_database
from app.recruits import NAMES, people_without_id
from app.study import load_study
from app.tables import demographics, events, participants, recruits, sessions, trials
from tests.app.conftest import ORIGIN, Browser
from tests.app.test_cli import run as run_process
from tests.server_process import ServerProcess

LINK = "?PROLIFIC_PID={}&STUDY_ID=s1&SESSION_ID=x1"


@pytest.fixture
def run(settings, monkeypatch):
    """Runs a command in this process on the test's database; returns its result."""
    monkeypatch.setenv("GOALGUESS_DATABASE_URL", settings.database_url)
    monkeypatch.setenv("GOALGUESS_CODES", json.dumps({"completed": "DONE1", "failed": "FAIL1"}))
    return lambda *arguments: CliRunner().invoke(commands, [*map(str, arguments)])


@pytest.fixture
def people(another_browser):
    """One finished, one failed, one on the way, one withdrawn, one without an id, two pilots."""
    visitors = [another_browser() for _ in range(7)]
    visitors[0].take_part(LINK.format("done"))
    visitors[1].consent(LINK.format("failing"))
    visitors[1].post("/failed")
    visitors[2].reach_practice("?PROLIFIC_PID=-waiting")
    visitors[3].consent(LINK.format("gone"))
    visitors[3].post("/withdraw")
    visitors[4].consent()
    visitors[5].consent(LINK.format("done") + "&preview=1")
    visitors[6].consent("?simulated=1")
    return visitors


@pytest.mark.usefixtures("people")
def test_recruits_lists_real_participants_with_ending_and_code(run):
    result = run("recruits")
    assert result.exit_code == 0
    heading, *lines = [line.split() for line in result.stdout.splitlines()]
    assert heading == list(NAMES)
    assert [line[:5] for line in lines[:2]] == [
        ["done", "s1", "x1", "completed", "DONE1"],
        ["failing", "s1", "x1", "failed", "FAIL1"],
    ]
    assert lines[2][:2] == ["-waiting", "practice"]
    assert len(lines) == 3
    assert "1 participant came without a recruiter's id" in result.stderr


@pytest.mark.usefixtures("people")
def test_the_file_of_recruits_holds_the_same_and_is_its_owners_alone(run, tmp_path):
    file = tmp_path / "recruits.csv"
    result = run("recruits", "--csv", file)
    assert result.exit_code == 0
    assert "3 recruits" in result.stdout
    assert "done" not in result.stdout
    rows = list(csv.DictReader(io.StringIO(file.read_text(encoding="utf-8"))))
    assert [row["recruiter_id"] for row in rows] == ["done", "failing", "'-waiting"]
    assert [row["code"] for row in rows] == ["DONE1", "FAIL1", ""]
    assert rows[0]["consented_at"] <= rows[0]["finished_at"]
    assert rows[2]["finished_at"] == ""
    assert stat.S_IMODE(file.stat().st_mode) == 0o600


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "\t", "\r"])
def test_no_cell_of_the_file_is_a_formula(run, browser, client, tmp_path, start):
    browser.consent(LINK.format("p1"))
    database = client.app.state.services.database
    older = update(recruits).values(recruiter_id=f"{start}1+1", recruiter_study=f"{start}2")
    database.submit(lambda connection: connection.execute(older)).result()
    run("recruits", "--csv", tmp_path / "recruits.csv")
    with (tmp_path / "recruits.csv").open(encoding="utf-8", newline="") as file:
        (row,) = csv.DictReader(file)
    assert (row["recruiter_id"], row["study_id"]) == (f"'{start}1+1", f"'{start}2")


@pytest.mark.usefixtures("client")
def test_a_file_that_cannot_be_written_is_one_line_and_nothing_is_left(run, tmp_path):
    (tmp_path / "folder").mkdir()
    before = sorted(tmp_path.rglob("*"))
    for target in ("folder", "none/recruits.csv", "study.sqlite/recruits.csv"):
        result = run("recruits", "--csv", tmp_path / target)
        assert isinstance(result.exception, AppError)
        assert "expected a file to write to, got: " in str(result.exception)
        assert "Errno" not in str(result.exception)
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.usefixtures("client")
def test_without_recruits_the_list_says_so(run):
    assert run("recruits").stdout == "No participant with a recruiter's id has given consent.\n"


def test_who_came_without_an_id_is_counted_but_not_pilots_and_the_withdrawn(
    another_browser, client
):
    database = client.app.state.services.database
    assert database.read_now(people_without_id) is None
    for query in ("", "", "?preview=1", LINK.format("p1")):
        another_browser().consent(query)
    gone = another_browser()
    gone.consent()
    gone.post("/withdraw")
    line = database.read_now(people_without_id)
    assert line == "2 participants came without a recruiter's id: nobody can tell whom to pay " + (
        "for them."
    )


def test_a_withdrawal_by_letter_deletes_everything_of_everybody_under_the_id(
    run, settings, people, rows
):
    result = run("withdraw", "--recruiter-id", " done ")
    assert result.exit_code == 0
    assert result.stdout == "2 participants withdrawn: all that was known of them is deleted.\n"
    gone = [row for row in rows(participants) if row.step == "withdrawn"]
    assert sorted(row.stream for row in gone) == ["participant", "participant", "preview"]
    for table in (trials, events, demographics, recruits, sessions):
        assert not {row.participant_id for row in rows(table)} & {row.id for row in gone}
    listed = settings.withdrawals_file.read_text().split()
    assert {row.pseudonym for row in gone} == set(listed)
    assert people[0].get("/end").status_code == 401
    assert people[2].get("/practice").status_code == 200
    assert run("recruits").stdout.count("done") == 0


def test_a_withdrawal_by_letter_works_when_the_study_is_closed(run, browser, settings, monkeypatch):
    browser.take_part(LINK.format("p1"))
    monkeypatch.setenv("GOALGUESS_STUDY_OPEN", "false")
    assert run("withdraw", "--recruiter-id", "p1").exit_code == 0
    database = open_database(load_study(settings))
    steps = database.read_now(lambda c: c.scalars(select(participants.c.step)).all())
    database.close()
    assert steps == ["withdrawn"]


@pytest.mark.parametrize("wanted", ["q7x9z", "", " "])
def test_an_id_that_nobody_has_withdraws_nobody_and_is_not_repeated(run, browser, rows, wanted):
    browser.consent()
    result = run("withdraw", "--recruiter-id", wanted)
    assert isinstance(result.exception, AppError)
    message = str(result.exception)
    assert message.startswith("--recruiter-id: expected an id that is stored in ")
    assert "q7x9z" not in message
    assert [row.step for row in rows(participants)] == ["about_you"]


@pytest.mark.parametrize("arguments", [["recruits"], ["withdraw", "--recruiter-id", "p1"]])
def test_without_a_database_each_command_is_one_line_and_makes_none(tmp_path, arguments):
    url = f"sqlite:///{tmp_path}/none.sqlite"
    done = run_process(*arguments, GOALGUESS_DATABASE_URL=url)
    assert done.returncode == 2
    assert "no such file" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


def test_a_withdrawal_by_letter_while_a_server_runs_leaves_nothing_in_the_files(tmp_path):
    file = tmp_path / "study.sqlite"
    url = f"sqlite:///{file}"
    with ServerProcess(file) as server:
        origin = server.url.rstrip("/")
        with httpx2.Client(base_url=origin, headers={"origin": origin}) as client:
            form = {"arrival": "x" * 20, "decision": "yes", "PROLIFIC_PID": "unmistakable"}
            assert client.post("/consent", data=form).status_code == 303
            assert client.get("/about-you").status_code == 200
            done = run_process(
                "withdraw", "--recruiter-id", "unmistakable", GOALGUESS_DATABASE_URL=url
            )
            assert done.returncode == 0, done.stderr
            assert client.get("/about-you").status_code == 401
        for left in tmp_path.iterdir():
            assert b"unmistakable" not in left.read_bytes(), left
    with sqlite3.connect(file) as connection:
        assert connection.execute("SELECT step FROM participants").fetchall() == [("withdrawn",)]


def test_the_start_says_how_many_came_without_an_id(settings, capfd):
    with TestClient(create_app(settings), base_url=ORIGIN) as client:
        Browser(client).consent()
    with ServerProcess(settings.database_file) as server:
        assert httpx2.get(server.url).status_code == 200
    assert capfd.readouterr().err == (
        "1 participant came without a recruiter's id: nobody can tell whom to pay for them.\n"
    )
