"""A study of one's own for each test, served for real, and visitors who come with a browser."""

import sqlite3
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, Request, sync_playwright

from app.settings import Settings
from tests.browser import chromium
from tests.browser.serving import Server

STEP_MS = 80
LEAD_IN_MS = 100
DESKTOP = {"width": 1280, "height": 800}
PHONE = {"width": 360, "height": 740}

Row = dict[str, Any]


@dataclass(frozen=True)
class Site:
    """A running study: its server and what it has stored."""

    server: Server
    database: Path

    @property
    def url(self) -> str:
        return self.server.url

    def rows(self, query: str) -> list[Row]:
        """What is stored, read past the server."""
        connection = sqlite3.connect(f"file:{self.database}?mode=ro", uri=True)
        connection.row_factory = sqlite3.Row
        try:
            return [dict(row) for row in connection.execute(query)]
        finally:
            connection.close()

    def trials(self) -> list[Row]:
        """The rows of the trials, in order."""
        return self.rows("select * from trials order by participant_id, trial_index")

    def events(self, kind: str) -> list[Row]:
        """The logged events of one type, in order."""
        return self.rows(f"select * from events where type = '{kind}' order by id")


@dataclass
class Guard:
    """Hears everything a browser complains about or asks of others; none of it may be."""

    url: str
    complaints: list[str] = field(default_factory=list)
    expected: tuple[str, ...] = ()

    def watch(self, page: Page) -> None:
        page.on("console", lambda message: self._hear(message.type, message.text))
        page.on("pageerror", lambda error: self.complaints.append(f"error: {error}"))
        page.on("request", self._request)

    def _hear(self, kind: str, text: str) -> None:
        if kind in ("error", "warning") and not any(part in text for part in self.expected):
            self.complaints.append(f"{kind}: {text}")

    def _request(self, request: Request) -> None:
        if not request.url.startswith((self.url, "blob:", "data:")):
            self.complaints.append(f"a request to another host: {request.url}")


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    return Settings(
        database_url=f"sqlite:///{tmp_path / 'study.sqlite'}",
        seed=1,
        step_ms=STEP_MS,
        lead_in_ms=LEAD_IN_MS,
        researchers="The Goalguess team, Example University",
        contact="study@example.org",
        codes={"completed": "DONE1", "no_consent": "NONE1", "screened_out": "OUT1"},
    )


@pytest.fixture
def site(settings: Settings) -> Iterator[Site]:
    server = Server(settings)
    server.start()
    yield Site(server, settings.database_file)
    server.stop()


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    path = chromium.find()
    assert path, "no Chromium: run python -m tests.browser.chromium"
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=list(chromium.FLAGS))
        yield browser
        browser.close()


@pytest.fixture
def guard(site: Site) -> Iterator[Guard]:
    guard = Guard(site.url)
    yield guard
    assert guard.complaints == []


Visit = Callable[..., Page]


@pytest.fixture
def visit(site: Site, browser: Browser, guard: Guard) -> Iterator[Visit]:
    """Opens the study in a fresh browser: `visit(viewport=PHONE, color_scheme="dark")`."""
    contexts: list[BrowserContext] = []

    def come(**options: Any) -> Page:
        context = browser.new_context(base_url=site.url, **{"viewport": DESKTOP, **options})
        context.set_default_timeout(10_000)
        context.on("page", guard.watch)
        contexts.append(context)
        return context.new_page()

    yield come
    for context in contexts:
        context.close()
