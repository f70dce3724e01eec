"""A simulated participant's browser: keeps a cookie, follows redirects, waits out an outage."""

import asyncio
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from httpx2 import AsyncClient, Response, TransportError
from pydantic import BaseModel

from app.bots.forms import Form, read_form
from app.errors import AppError, TooMany

FIRST_WAIT_S = 0.1
LONGEST_WAIT_S = 2.0
PATIENCE_S = 60.0
TOO_MANY = TooMany.status


class NoServer(AppError):
    """No study answered for as long as a browser has patience."""


class Refused(AppError):
    """The study refused what was sent; `code` as the reply names it."""

    def __init__(self, reply: Response) -> None:
        super().__init__(f"{reply.url}: refused with {reply.status_code}: {reply.text[:300]}")
        told = reply.headers.get("content-type") == "application/json"
        self.refusal = reply.json()["error"]["code"] if told else None


@dataclass(frozen=True)
class Page:
    """A page as it came, with the address where redirects ended; `at_home` unless an error."""

    address: str
    at_home: bool
    html: str

    @property
    def path(self) -> str:
        """The address without its query."""
        return self.address.partition("?")[0]

    @cached_property
    def form(self) -> Form:
        """The page's form; an empty one on pages without."""
        return read_form(self.html) or Form("")

    @property
    def participant(self) -> str | None:
        """Whose page it is, as it tells its scripts."""
        told = re.search(r'data-participant="(.*?)"', self.html)
        return told[1] if told else None

    @property
    def heading(self) -> str:
        """The words of the page's heading."""
        heading = re.search(r"<h1.*?>(.*?)</h1>", self.html, re.DOTALL)
        return re.sub(r"<.*?>", "", heading[1]).strip() if heading else self.path


class Browser:
    """Visits one study, with what our pages do about errors: try again, or tell."""

    def __init__(self, client: AsyncClient) -> None:
        self._client = client
        home = client.base_url
        self._root_path = home.path.rstrip("/")
        self._headers = {
            "origin": f"{home.scheme}://{home.netloc.decode('ascii')}",
            "user-agent": "goalguess simulate",
        }

    async def open(self, address: str) -> Page:
        """A page, wherever the server leads."""
        return self._page(await self._patiently("GET", address))

    async def submit(self, form: Form, values: Mapping[str, str]) -> Page:
        """Send a form with its hidden fields; the page that follows."""
        path = form.action.removeprefix(self._root_path)
        return self._page(await self._patiently("POST", path, data={**form.hidden, **values}))

    async def fetch(self, path: str) -> dict[str, Any]:
        """What a page's script asks for."""
        return _state(await self._patiently("GET", path))

    async def send(self, path: str, message: BaseModel) -> dict[str, Any]:
        """Send a message of a page's script; the reply."""
        return _state(await self._patiently("POST", path, content=message.model_dump_json()))

    async def ask(self, path: str) -> dict[str, Any]:
        """Ask for something that changes what is stored, as a page's script does."""
        return _state(await self._patiently("POST", path, content="{}"))

    async def _patiently(self, method: str, path: str, **request: Any) -> Response:
        wait, waited = FIRST_WAIT_S, 0.0
        while True:
            try:
                reply = await self._client.request(method, path, headers=self._headers, **request)
                if reply.status_code < 500 and reply.status_code != TOO_MANY:
                    return reply
                trouble = f"it answers {reply.status_code}"
                wait = max(wait, float(reply.headers.get("retry-after", 0)))
            except TransportError as error:
                trouble = f"{error} ({type(error).__name__})"
            if waited >= PATIENCE_S:
                raise NoServer(f"{self._client.base_url}: expected a running study: {trouble}")
            await asyncio.sleep(wait)
            waited += wait
            wait = min(2 * wait, LONGEST_WAIT_S)

    def _page(self, reply: Response) -> Page:
        # 409 is a page for people: the study is closed, or went on in another browser.
        if reply.status_code not in (200, 409):
            raise Refused(reply)
        address = reply.url.raw_path.decode("ascii").removeprefix(self._root_path)
        return Page(address, reply.status_code == 200, reply.text)


def _state(reply: Response) -> dict[str, Any]:
    if reply.status_code != 200:
        raise Refused(reply)
    state: dict[str, Any] = reply.json()
    return state
