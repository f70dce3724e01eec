"""What a server writes while everything fails: nothing of whom it happened to."""

import logging
import re
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import uvicorn
from httpx2 import Client
from starlette.testclient import TestClient

from app.main import create_app
from tests import messages
from tests.app.conftest import ORIGIN, Browser
from tests.server_process import ServerProcess

LINK = "?PROLIFIC_PID=60aPARTICIPANTf1&STUDY_ID=60bSTUDYf2&SESSION_ID=60cSESSIONf3"
ABOUT_ME = messages.ABOUT_ME | {"nationality": "Ruritanian"}
SECRETS = {"60aPARTICIPANTf1", "60bSTUDYf2", "60cSESSIONf3", "Ruritanian"}
TABLES = ["recruits", "sessions", "demographics", "places", "trials", "events", "participants"]


@contextmanager
def without(database: Path, table: str) -> Iterator[None]:
    """A database in use in which a table cannot be found."""
    for before, after in ((table, "gone"), ("gone", table)):
        with sqlite3.connect(database, timeout=10) as connection:
            connection.execute(f"ALTER TABLE {before} RENAME TO {after}")
        connection.close()
        if after == "gone":
            yield


def damage_indexes(database: Path) -> None:
    """Overwrite every index of a database in use; what reads one finds it malformed."""
    connection = sqlite3.connect(database, isolation_level=None, timeout=10)
    connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    size = connection.execute("PRAGMA page_size").fetchone()[0]
    pages = connection.execute("SELECT rootpage FROM sqlite_master WHERE type = 'index'").fetchall()
    with database.open("r+b") as file:
        for (page,) in pages:
            file.seek((page - 1) * size)
            file.write(b"\xff" * size)
    # Something of another process: the server reads again what it remembers.
    connection.execute("PRAGMA user_version = 7")
    connection.close()


def try_everything(browser: Browser) -> set[int]:
    """All that a participant can send, whatever comes of it; the statuses of the replies."""
    event = messages.event("focus_lost")
    body = {"key": messages.key(), "trial_index": 1, "position_ms": 5, "events": [event]}
    replies = [
        browser.get(f"/{LINK}"),
        browser.consent(LINK),
        browser.post("/about-you", ABOUT_ME),
        browser.post("/instructions"),
        browser.post("/practice", messages.RIGHT_ANSWER),
        browser.get("/trial"),
        browser.send("/api/events", body),
        browser.send("/api/trials/1/played", messages.played("none")),
        browser.send("/api/trials/1/stopped", messages.stopped(5000)),
        browser.send("/api/trials/1/answered", messages.answered("A", 5000)),
        browser.get("/end"),
        browser.post("/withdraw"),
    ]
    return {reply.status_code for reply in replies}


def test_no_log_says_whom_anything_happened_to(tmp_path):
    database, log = tmp_path / "study.sqlite", tmp_path / "log"
    secrets = set(SECRETS)
    with log.open("w") as file, ServerProcess(database, file) as server:
        # The whole study, which works; then everything again with a table missing each time.
        for missing in [None, *TABLES, "indexes"]:
            with Client(base_url=server.url, headers={"host": "study.test"}) as client:
                browser = Browser(client)
                browser.reach_practice(LINK)
                secrets |= set(
                    re.findall(r'data-participant="(.+?)"', browser.get("/practice").text)
                )
                secrets |= set(client.cookies.values())
                if missing is None:
                    browser.post("/practice", messages.RIGHT_ANSWER)
                    assert browser.finish_trial(1).status_code == 200
                    assert browser.post("/withdraw").status_code == 303
                elif missing == "indexes":
                    damage_indexes(database)
                    assert max(try_everything(browser)) >= 500
                else:
                    with without(database, missing):
                        assert max(try_everything(browser)) >= 500
                    browser.post("/withdraw")
    said = log.read_text()
    for table in TABLES:
        assert f"no such table: {table}" in said or f"no such table: main.{table}" in said
    assert "is damaged" in said
    assert len(secrets) >= len(SECRETS) + 4
    assert [secret for secret in secrets if secret in said] == []


def test_requests_are_not_logged_whoever_configures_uvicorn(settings, capsys):
    app = create_app(settings)
    uvicorn.Config(app)  # what it does to the loggers by default
    logger = logging.getLogger("uvicorn.access")
    with TestClient(app, base_url=ORIGIN):
        logger.info('%s - "%s %s HTTP/%s" %d', "192.0.2.1:1", "GET", f"/{LINK}", "1.1", 200)
    printed = capsys.readouterr()
    assert printed.out + printed.err == ""


@pytest.fixture(autouse=True)
def _loggers_as_before():
    names = ["uvicorn", "uvicorn.error", "uvicorn.access"]
    loggers = [logging.getLogger(name) for name in names]
    before = [(one.handlers[:], one.level, one.propagate, one.disabled) for one in loggers]
    yield
    for one, state in zip(loggers, before, strict=True):
        one.handlers[:], one.level, one.propagate, one.disabled = state
