"""How the study is served: uvicorn, with a bound on all that a connection may hold or delay."""

import asyncio
import resource
from typing import Any

import uvicorn
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp
from uvicorn.protocols.http.httptools_impl import (
    STATUS_LINE,
    HttpToolsProtocol,
    RequestResponseCycle,
)

from app.security import HEADERS, LARGEST_BODY
from app.settings import Settings

LARGEST_HEAD = 32 * 1024
"""Request line and headers, bytes; browsers send less than 8 KiB."""
LARGEST_REQUEST = LARGEST_HEAD + 2 * LARGEST_BODY
"""With room for the frame of a body sent in chunks; a larger body is answered by the app."""
RECEIVE_S = 30
"""For one whole request: twice what our pages wait for its answer."""
LAST_S = 1
"""For the rest of a request when the server is to end."""
GRACE_S = 8
"""For what is being answered when the server is to end; Docker waits 10 s before it kills."""
MOST_CONNECTIONS = 2000
"""200 participants at once, six connections each, leave room for those who have just left."""
MOST_TURNED_AWAY = 100
"""Connections beyond the limit that are answered in words; all others are cut."""
AGAIN_S = 60
"""After which whoever was turned away may come again."""
OTHER_FILES = 100
"""Files this process may need beside its connections."""

BUSY = "Very many people are here just now. Nothing is lost: please load it again in a minute."
SLOW = "The request did not arrive in time. Please try again."
LARGE_HEAD = f"Expected at most {LARGEST_HEAD} bytes of headers."
LARGE_REQUEST = f"Expected at most {LARGEST_BODY} bytes."


class StudyConfig(uvicorn.Config):
    """What uvicorn needs to serve a study; the only place that decides it."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        super().__init__(
            app,
            http=BoundedProtocol,
            ws="none",
            log_level="warning",
            # Its lines would hold the invitation links, and with them people's ids.
            access_log=False,
            timeout_keep_alive=settings.keep_alive_s,
            timeout_graceful_shutdown=GRACE_S,
        )
        self.most_connections = _files_for(MOST_CONNECTIONS)


class BoundedProtocol(HttpToolsProtocol):
    """uvicorn's own protocol, which waits for a request without end and reads any head."""

    config: StudyConfig

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._received = 0  # bytes of the request that is arriving
        self._in_head = True
        self._deadline: asyncio.TimerHandle | None = None  # for the rest of it
        self._answering: RequestResponseCycle | None = None
        self._unread: asyncio.TimerHandle | None = None  # runs while nobody reads our reply

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin a connection; one too many is turned away."""
        super().connection_made(transport)
        beyond = len(self.connections) - self.config.most_connections
        if beyond > MOST_TURNED_AWAY:
            transport.abort()
            return
        if beyond > 0:
            self.app = _refusal(503, BUSY, {"retry-after": str(AGAIN_S)})
        self._expect_within(RECEIVE_S)

    def connection_lost(self, exc: Exception | None) -> None:
        """End it, and whatever waits for it."""
        super().connection_lost(exc)
        # uvicorn tells the last request's answer only, which may still wait for an earlier one.
        self._say_no_more(self._answering)
        for timer in (self._deadline, self._unread):
            if timer:
                timer.cancel()

    def data_received(self, data: bytes) -> None:
        """Take in what came, unless it is too much."""
        self._received += len(data)
        super().data_received(data)
        if self.transport.is_closing():
            return
        if self._in_head and self._received > LARGEST_HEAD:
            self._refuse(431, LARGE_HEAD)
        elif self._received > LARGEST_REQUEST:
            self._refuse(413, LARGE_REQUEST)
        elif self._received and not self._deadline:
            self._expect_within(RECEIVE_S)

    def on_headers_complete(self) -> None:
        """Start answering, in few words where the head came at once and is too large."""
        self._in_head = False
        head = len(self.url) + sum(len(name) + len(value) for name, value in self.headers)
        if head > LARGEST_HEAD:
            self.app = _refusal(431, LARGE_HEAD, {})
        super().on_headers_complete()

    def on_message_complete(self) -> None:
        """The request is here; what may follow it in the same piece is not counted."""
        self._received, self._in_head = 0, True
        if self._deadline:
            self._deadline.cancel()
            self._deadline = None
        super().on_message_complete()

    def shutdown(self) -> None:
        """End soon: whoever has begun to send, or to read, gets a moment more."""
        super().shutdown()
        if self._deadline:
            self._expect_within(LAST_S)
        if self._unread:
            self.loop.call_later(LAST_S, self.transport.abort)

    def timeout_keep_alive_handler(self) -> None:
        """Close a connection that nobody has used for long."""
        self._close()

    def pause_writing(self) -> None:
        """Wait for the other side to read, but not for ever."""
        super().pause_writing()
        self._expect_reader()

    def resume_writing(self) -> None:
        """Go on writing."""
        if self._unread and not self.transport.is_closing():
            self._unread.cancel()
            self._unread = None
        super().resume_writing()

    def _start_asgi_task(self, cycle: RequestResponseCycle, app: Any) -> None:
        self._answering = cycle
        super()._start_asgi_task(cycle, app)

    def _say_no_more(self, cycle: RequestResponseCycle | None) -> None:
        """Let the app hear that the rest will not come, and drop what it says."""
        if cycle and not cycle.response_complete:
            cycle.disconnected = True
            cycle.message_event.set()

    def _expect_within(self, seconds: float) -> None:
        if self._deadline:
            self._deadline.cancel()
        self._deadline = self.loop.call_later(seconds, self._refuse, 408, SLOW)

    def _refuse(self, status: int, words: str) -> None:
        """Close, with a reply where one is due and none has begun."""
        answering = self.cycle is not None and not self.cycle.response_complete
        if self._in_head:
            due = self._received > 0 and not answering
        else:
            due = answering and not self.cycle.response_started and not self.pipeline
        self._say_no_more(self.cycle)
        if due:
            body = words.encode()
            fields = {**_FIELDS, "content-length": str(len(body)), "connection": "close"}
            head = "".join(f"{name}: {value}\r\n" for name, value in fields.items())
            self.transport.write(STATUS_LINE[status] + head.encode() + b"\r\n" + body)
        self._close()

    def _close(self) -> None:
        if not self.transport.is_closing():
            self.transport.close()
        # Closing waits until the other side has read everything.
        self._expect_reader()

    def _expect_reader(self) -> None:
        self._unread = self._unread or self.loop.call_later(RECEIVE_S, self.transport.abort)


_FIELDS = {**HEADERS, "content-type": "text/plain; charset=utf-8", "cache-control": "no-store"}


def _refusal(status: int, words: str, fields: dict[str, str]) -> ASGIApp:
    """An application that says no to everything, and then closes."""
    return PlainTextResponse(words, status, {**_FIELDS, "connection": "close", **fields})


def _files_for(connections: int) -> int:
    """How many connections this process may have open, at most so many."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    needed = connections + OTHER_FILES
    if hard != resource.RLIM_INFINITY:
        needed = min(needed, hard)
    if soft != resource.RLIM_INFINITY and soft < needed:
        resource.setrlimit(resource.RLIMIT_NOFILE, (needed, hard))
    return needed - OTHER_FILES
