"""A study of one's own for each test: settings, a fresh database, and browsers to visit it."""

import re
import shutil
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from httpx2 import Client, Response
from sqlalchemy import Select, Table, select
from starlette.testclient import TestClient

from app import repository
from app.database import Database
from app.export import export
from app.main import create_app
from app.opening import open_database
from app.schema import prepare
from app.settings import Settings
from app.study import Study, load_study
from tests import messages

ORIGIN = "http://study.test"


@pytest.fixture(scope="session")
def empty_database(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A migrated, empty database to copy."""
    file = tmp_path_factory.mktemp("database") / "empty.sqlite"
    prepare(f"sqlite:///{file}", str(file))
    return file


@pytest.fixture
def settings(tmp_path: Path, empty_database: Path) -> Settings:
    file = tmp_path / "study.sqlite"
    shutil.copy(empty_database, file)
    return Settings(database_url=f"sqlite:///{file}", seed=1, codes={"completed": "DONE1"})


@pytest.fixture
def study(settings: Settings) -> Study:
    return load_study(settings)


@pytest.fixture
def database(study: Study) -> Iterator[Database]:
    database = open_database(study)
    yield database
    database.close()


@pytest.fixture
def write(client: TestClient, study: Study, tmp_path: Path) -> Callable[..., Any]:
    """Exports the study; returns the numbers of rows, and the folder."""

    def run(simulated: bool = False) -> tuple[dict[str, int], Path]:
        database: Database = client.app.state.services.database  # type: ignore[attr-defined]
        done = export(database, study, tmp_path / "out", simulated)
        return done.rows, tmp_path / "out"

    return run


@pytest.fixture
def wait(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], None]:
    """The server's clock stands still, but for the seconds that a test waits."""
    time = [datetime(2025, 3, 1, 9, 30, tzinfo=UTC)]
    monkeypatch.setattr(repository, "now", lambda: time[-1])
    return lambda seconds: time.append(time[-1] + timedelta(seconds=seconds))


class Browser:
    """A participant's browser: keeps cookies, sends what our pages send."""

    def __init__(self, client: Client) -> None:
        self.client = client

    def get(self, path: str) -> Response:
        return self.client.get(path, follow_redirects=False)

    def post(self, path: str, form: dict[str, str] | None = None) -> Response:
        headers = {"origin": ORIGIN}
        return self.client.post(path, data=form or {}, headers=headers, follow_redirects=False)

    def send(self, path: str, body: dict[str, Any]) -> Response:
        return self.client.post(path, json=body, headers={"origin": ORIGIN})

    def hidden_fields(self, path: str) -> dict[str, str]:
        """What the form of a page sends along."""
        page = self.get(path)
        return dict(re.findall(r'type="hidden" name="(.*?)" value="(.*?)"', page.text))

    def consent(self, query: str = "", decision: str = "yes") -> Response:
        return self.post("/consent", {**self.consent_form(query), "decision": decision})

    def consent_form(self, query: str = "") -> dict[str, str]:
        """The hidden fields of one showing of the consent form."""
        return self.hidden_fields(f"/{query}")

    def go_on_here(self, query: str) -> Response:
        """Open the link in this browser, and press the button."""
        return self.post("/go-on", self.hidden_fields(f"/{query}"))

    def reach_practice(self, query: str = "") -> None:
        self.consent(query)
        self.post("/about-you", messages.ABOUT_ME)
        self.post("/instructions")

    def reach_trials(self, query: str = "") -> None:
        self.reach_practice(query)
        assert self.post("/practice", messages.RIGHT_ANSWER).headers["location"] == "/trial"

    def trial(self) -> dict[str, Any]:
        state: dict[str, Any] = self.get("/api/trial").json()
        return state

    def current(self) -> dict[str, Any]:
        """The trial the participant is at; empty when there is none."""
        return self.trial().get("trial") or {}

    def play(self, index: int, **changes: Any) -> Response:
        body = messages.played(self.current().get("ticket", "none"))
        return self.send(f"/api/trials/{index}/played", body | changes)

    def stop(self, index: int, stop_time_ms: float, **changes: Any) -> Response:
        body = messages.stopped(stop_time_ms)
        return self.send(f"/api/trials/{index}/stopped", body | changes)

    def answer(self, index: int, guess: str = "A", **changes: Any) -> Response:
        body = messages.answered(guess, self.current().get("stop_time_ms") or 0)
        return self.send(f"/api/trials/{index}/answered", body | changes)

    def finish_trial(self, index: int, guess: str = "A", stop_time_ms: float = 5000) -> Response:
        self.play(index)
        self.stop(index, stop_time_ms)
        return self.answer(index, guess)

    def take_part(self, query: str = "") -> None:
        """The whole study."""
        self.reach_trials(query)
        for index in range(1, 11):
            assert self.finish_trial(index).status_code == 200


@pytest.fixture
def client(settings: Settings) -> Iterator[TestClient]:
    with TestClient(create_app(settings), base_url=ORIGIN) as client:
        yield client


@pytest.fixture
def browser(client: TestClient) -> Browser:
    return Browser(client)


@pytest.fixture
def another_browser(client: TestClient) -> Callable[[], Browser]:
    """Makes further browsers that visit the same study."""

    def make() -> Browser:
        return Browser(TestClient(client.app, base_url=ORIGIN))

    return make


@pytest.fixture
def rows(client: TestClient) -> Callable[..., list[Any]]:
    """Reads stored rows of a table, or of any query."""

    def read(what: Table | Select[Any]) -> list[Any]:
        query = select(what) if isinstance(what, Table) else what
        database: Database = client.app.state.services.database  # type: ignore[attr-defined]
        return list(database.read_now(lambda connection: connection.execute(query).all()))

    return read
