"""What a connection may hold or delay: heads, bodies, silence, many at once, the end."""

import re
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from app import serving
from app.settings import Settings
from tests.browser.serving import Server
from tests.server_process import ServerProcess

HALF_SENT = (
    b"POST /consent HTTP/1.1\r\nhost: study.test\r\norigin: http://study.test\r\n"
    b"content-type: application/x-www-form-urlencoded\r\ncontent-length: 100\r\n\r\ndecision="
)
GET = b"GET /no-consent HTTP/1.1\r\nhost: study.test\r\n\r\n"
SLOW_S = 0.5


@contextmanager
def connected(port: int) -> Iterator[socket.socket]:
    with socket.create_connection(("127.0.0.1", port), timeout=20) as connection:
        yield connection


def all_from(connection: socket.socket) -> bytes:
    """Everything the server says until it closes; a reset is a close too."""
    said = b""
    while True:
        try:
            piece = connection.recv(65536)
        except ConnectionResetError:
            return said
        if not piece:
            return said
        said += piece


@pytest.fixture
def server(settings: Settings, monkeypatch: pytest.MonkeyPatch) -> Iterator[Server]:
    """A server that is less patient than the real one."""
    monkeypatch.setattr(serving, "RECEIVE_S", SLOW_S)
    server = Server(settings.model_copy(update={"keep_alive_s": 1}))
    server.start()
    yield server
    server.stop()


@pytest.fixture
def port(server: Server) -> int:
    return server.port


@pytest.fixture
def process(tmp_path: Path) -> Iterator[ServerProcess]:
    with (tmp_path / "log").open("w") as log, ServerProcess(tmp_path / "s.sqlite", log) as process:
        yield process


def assert_no_trouble(log: Path) -> None:
    said = log.read_text()
    assert "Traceback" not in said
    assert "Cancel" not in said


def peak_mb(pid: int) -> float:
    found = re.search(r"VmHWM:\s+(\d+)", Path(f"/proc/{pid}/status").read_text())
    assert found
    return int(found[1]) / 1024


def test_a_half_sent_body_does_not_keep_the_server_from_ending(process, tmp_path):
    with connected(process.port) as connection:
        connection.sendall(HALF_SENT)
        time.sleep(0.2)
        began = time.monotonic()
        process.stop()
        assert time.monotonic() - began < serving.GRACE_S
        assert b" 408 " in all_from(connection)
    assert_no_trouble(tmp_path / "log")


def unread(port: int) -> socket.socket:
    """A connection that asks for more than the system keeps for it, and never reads."""
    page = urllib.request.urlopen(f"http://127.0.0.1:{port}/").read().decode()
    root = re.findall(r'href="(\S+)/style.css"', page)[0]
    connection = socket.create_connection(("127.0.0.1", port), timeout=20)
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    ask = f"GET {root}/rerun-states-measure.svg HTTP/1.1\r\nhost: study.test\r\n\r\n"
    for _ in range(60):
        connection.sendall(ask.encode())
        time.sleep(0.01)
    return connection


def test_a_reply_that_nobody_reads_does_not_keep_the_server_from_ending(process, tmp_path):
    with unread(process.port):
        began = time.monotonic()
        process.stop()
        assert time.monotonic() - began < serving.GRACE_S
    assert_no_trouble(tmp_path / "log")


def test_who_never_reads_the_reply_is_let_go(server):
    connections = server.connections
    with unread(server.port):
        assert len(connections) == 1
        time.sleep(3 * SLOW_S)
        assert not connections


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="reads /proc")
@pytest.mark.parametrize(
    "head", [b"x: " + b"a" * 1000, b"x: y\r\n" * 200], ids=["one endless line", "endless lines"]
)
def test_a_flood_of_headers_is_refused_and_takes_no_memory(process, head):
    before = peak_mb(process.pid)
    sent, refused = 0, False
    with connected(process.port) as connection:
        connection.sendall(b"GET / HTTP/1.1\r\nhost: study.test\r\nx: ")
        while sent < 50_000_000 and not refused:
            try:
                connection.sendall(head)
            except OSError:
                refused = True
            sent += len(head)
    assert refused
    assert peak_mb(process.pid) - before < 8


@pytest.mark.parametrize("end", [b"\r\n\r\n", b""], ids=["whole", "without an end"])
@pytest.mark.parametrize("size", [serving.LARGEST_HEAD, 60_000])
def test_a_head_that_is_too_large_is_refused_in_words(port, size, end):
    with connected(port) as connection:
        connection.sendall(GET[:-2] + b"x: " + b"a" * size + end)
        said = all_from(connection)
    assert said.startswith(b"HTTP/1.1 431 ")
    assert said.endswith(b"bytes of headers.")


def test_a_head_as_large_as_browsers_send_is_read(port):
    with connected(port) as connection:
        connection.sendall(GET[:-2] + b"cookie: " + b"a" * 20_000 + b"\r\n\r\n")
        assert connection.recv(100).startswith(b"HTTP/1.1 200 ")


@pytest.mark.parametrize("part", [GET[:20], HALF_SENT], ids=["head", "body"])
def test_who_sends_too_slowly_is_told_and_let_go(port, part):
    began = time.monotonic()
    with connected(port) as connection:
        for piece in (part[:-2], part[-2:-1]):
            connection.sendall(piece)
            time.sleep(0.6 * SLOW_S)
        said = all_from(connection)
    assert said.startswith(b"HTTP/1.1 408 ")
    assert time.monotonic() - began < 10 * SLOW_S


@pytest.mark.parametrize("sent", [b"", GET, b"\r\n"], ids=["nothing", "one request", "blank"])
def test_a_connection_that_nobody_uses_is_closed(port, sent):
    with connected(port) as connection:
        connection.sendall(sent)
        said = all_from(connection)
    assert (b"200 OK" in said) == (sent == GET)


def test_one_connection_too_many_is_told_to_come_again(settings, monkeypatch):
    monkeypatch.setattr(serving, "MOST_CONNECTIONS", 5)
    server = Server(settings)
    server.start()
    try:
        within = [socket.create_connection(("127.0.0.1", server.port)) for _ in range(5)]
        with connected(server.port) as one_too_many:
            one_too_many.sendall(GET)
            said = all_from(one_too_many)
        assert said.startswith(b"HTTP/1.1 503 ")
        assert b"retry-after: 60" in said
        assert b"Nothing is lost" in said
        within[0].sendall(GET)
        assert within[0].recv(100).startswith(b"HTTP/1.1 200 ")
        for connection in within:
            connection.close()
    finally:
        server.stop()


def test_so_many_connections_are_possible_as_are_promised():
    code = (
        "import resource\n"
        "from app.serving import MOST_CONNECTIONS, _files_for\n"
        "_, hard = resource.getrlimit(resource.RLIMIT_NOFILE)\n"
        "resource.setrlimit(resource.RLIMIT_NOFILE, (256, {hard}))\n"
        "print(_files_for(MOST_CONNECTIONS), resource.getrlimit(resource.RLIMIT_NOFILE)[0])"
    )

    def run(hard: str) -> list[str]:
        done = subprocess.run(
            [sys.executable, "-c", code.format(hard=hard)],
            capture_output=True,
            text=True,
            check=True,
        )
        return done.stdout.split()

    assert run("hard") == ["2000", "2100"]
    assert run("1024") == ["924", "1024"]
