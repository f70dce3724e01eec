"""Serves a study for real, on a free port of this machine."""

import socket
import threading
import time
from collections.abc import Callable, Iterator, Sized
from contextlib import contextmanager

import uvicorn
from starlette.types import ASGIApp

from app.main import create_app
from app.serving import StudyConfig
from app.settings import Settings

Front = Callable[[ASGIApp], ASGIApp]


class Server:
    """A study's server; however often it is stopped and started, its port and database stay.

    `front` is what stands before it, as a proxy does.
    """

    def __init__(self, settings: Settings, front: Front = lambda study: study) -> None:
        self._settings = settings
        self._front = front
        self.port = free_port()
        self.url = f"http://127.0.0.1:{self.port}"

    def start(self) -> None:
        """Serve; returns when requests are answered."""
        listener = socket.create_server(("127.0.0.1", self.port))
        app = self._front(create_app(self._settings))
        self._server = uvicorn.Server(StudyConfig(app, self._settings))
        self._thread = threading.Thread(target=self._server.run, args=([listener],))
        self._thread.start()
        while not self._server.started:
            if not self._thread.is_alive():
                raise RuntimeError("the server did not start")
            time.sleep(0.01)

    @property
    def connections(self) -> Sized:
        """Who is connected now."""
        return self._server.server_state.connections

    def stop(self) -> None:
        """Close the database and the port; one that stands still already stays so."""
        self._server.should_exit = True
        self._thread.join()


@contextmanager
def served(settings: Settings) -> Iterator[str]:
    """A study on a free port of this machine; its address."""
    server = Server(settings)
    server.start()
    try:
        yield server.url
    finally:
        server.stop()


def free_port() -> int:
    """A port that nobody listens on."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port: int = free.getsockname()[1]
    return port
