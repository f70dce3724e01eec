"""The study in a process of its own, as `goalguess serve` runs it: to be measured and killed."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from types import TracebackType
from typing import IO, get_args

from app.settings import Ending

COMPLETE = {
    "researchers": "The Goalguess team",
    "contact": "study@example.org",
    "codes": json.dumps({ending: f"{ending.upper()}1" for ending in get_args(Ending)}),
}
"""Without these, the server says at each start what is not set."""


class ServerProcess:
    """A server on a database file; once started, it keeps its port over every restart."""

    def __init__(self, database: Path, log: IO[str] | None = None, **settings: object) -> None:
        variables = {"database_url": f"sqlite:///{database}", **COMPLETE, **settings}
        named = {f"GOALGUESS_{name.upper()}": str(value) for name, value in variables.items()}
        self._log = log
        self._environment = {**os.environ, **named}
        self.port = 0

    def __enter__(self) -> "ServerProcess":
        self.start()
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        self.stop()

    @property
    def url(self) -> str:
        """The address of the study."""
        return f"http://127.0.0.1:{self.port}/"

    @property
    def pid(self) -> int:
        """The process that serves now."""
        return self._process.pid

    def start(self) -> None:
        """Serve, and return when requests are answered."""
        command = [sys.executable, "-u", "-m", "app.cli", "serve", "--port", str(self.port)]
        self._process = subprocess.Popen(
            command, env=self._environment, stdout=subprocess.PIPE, stderr=self._log, text=True
        )
        assert self._process.stdout
        announced = (re.search(r"http://[^:]+:(\d+)/", line) for line in self._process.stdout)
        self.port = next(int(found[1]) for found in announced if found)

    def stop(self) -> None:
        """End it as Ctrl+C does."""
        self._process.terminate()
        self._ended()

    def kill(self) -> None:
        """End it as a crash does: nothing is finished, nothing is said."""
        self._process.kill()
        self._ended()

    def _ended(self) -> None:
        assert self._process.stdout
        if self._log and not self._process.stdout.closed:
            self._log.write(self._process.stdout.read())
            self._log.flush()
        self._process.stdout.close()
        self._process.wait()
