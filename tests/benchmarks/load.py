"""How many whole participants a second the server takes, on SQLite, each answer synced to disk.

Example: python -m tests.benchmarks.load --participants 400 --at-once 50

Starts a server of its own on a temporary database, sends it what participants' browsers send
(pages, then JSON), checks that every acknowledged answer is stored, and prints a table.
"""

import argparse
import asyncio
import json
import re
import sqlite3
import sys
import tempfile
import time
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

import numpy as np

from tests import messages
from tests.server_process import ServerProcess

FORM = "application/x-www-form-urlencoded"
Times = dict[str, list[float]]


class Browser:
    """One keep-alive connection with its cookie; HTTP libraries are slower than the server."""

    def __init__(self, port: int, times_ms: Times) -> None:
        self.host = f"127.0.0.1:{port}"
        self.port = port
        self.times_ms = times_ms
        self.cookie = ""

    async def __aenter__(self) -> "Browser":
        self.reader, self.writer = await asyncio.open_connection("127.0.0.1", self.port)
        return self

    async def __aexit__(self, *_error: object) -> None:
        self.writer.close()
        await self.writer.wait_closed()

    async def get(self, path: str) -> bytes:
        return await self._request("GET", path, b"", FORM, "page")

    async def post(self, path: str, form: dict[str, str]) -> bytes:
        return await self._request("POST", path, urlencode(form).encode(), FORM, "form")

    async def send(self, path: str, body: dict[str, Any]) -> dict[str, Any]:
        content = json.dumps(body).encode()
        kind = path.rpartition("/")[2]
        reply = await self._request("POST", path, content, "application/json", kind)
        state: dict[str, Any] = json.loads(reply)
        return state

    async def _request(self, method: str, path: str, body: bytes, media: str, kind: str) -> bytes:
        head = (
            f"{method} {path} HTTP/1.1\r\nhost: {self.host}\r\norigin: http://{self.host}\r\n"
            f"content-type: {media}\r\ncontent-length: {len(body)}\r\ncookie: {self.cookie}\r\n\r\n"
        )
        began = time.perf_counter()
        self.writer.write(head.encode() + body)
        reply = (await self.reader.readuntil(b"\r\n\r\n")).decode()
        length = re.search(r"content-length: (\d+)", reply)
        content = await self.reader.readexactly(int(length[1])) if length else b""
        self.times_ms.setdefault(kind, []).append(1000 * (time.perf_counter() - began))
        if int(reply.split()[1]) >= 400:
            raise RuntimeError(f"{method} {path}: {reply.splitlines()[0]} {content[:200]!r}")
        cookie = re.search(r"set-cookie: (\S+);", reply)
        self.cookie = cookie[1] if cookie else self.cookie
        return content


async def take_part(port: int, times_ms: Times, rng: np.random.Generator) -> None:
    """One participant, without the time that people take."""
    async with Browser(port, times_ms) as browser:
        page = (await browser.get("/?simulated=1")).decode()
        fields = dict(re.findall(r'type="hidden" name="(.*?)" value="(.*?)"', page))
        await browser.post("/consent", {**fields, "decision": "yes"})
        await browser.get("/about-you")
        await browser.post("/about-you", messages.ABOUT_ME)
        await browser.get("/instructions")
        await browser.post("/instructions", {})
        await browser.get("/practice")
        await browser.get("/api/practice")
        await browser.post("/practice", messages.RIGHT_ANSWER)
        await browser.get("/trial")
        state = json.loads(await browser.get("/api/trial"))
        while state["trial"]:
            trial = state["trial"]
            length_ms = trial["playback"]["step_ms"] * (len(trial["playback"]["path"]) - 1)
            stop_ms = rng.uniform(0, length_ms)
            at = f"/api/trials/{trial['index']}"
            await browser.send(f"{at}/played", messages.played(trial["ticket"]))
            await browser.send(f"{at}/stopped", messages.stopped(stop_ms))
            guess, confidence = "ABCDEF"[rng.integers(6)], int(rng.integers(1, 8))
            answer = messages.answered(guess, stop_ms, confidence)
            state = await browser.send(f"{at}/answered", answer)
        await browser.get("/end")


async def all_take_part(port: int, participants: int, at_once: int, seed: int) -> Times:
    """All participants, at most so many at once; returns the times of all requests."""
    times_ms: Times = {}
    turns = asyncio.Semaphore(at_once)

    async def one(rng: np.random.Generator) -> None:
        async with turns:
            await take_part(port, times_ms, rng)

    streams = np.random.default_rng(seed).spawn(participants)
    await asyncio.gather(*(one(rng) for rng in streams))
    return times_ms


def memory_mb(pid: int) -> float:
    """Resident memory of a process, MB; nan where /proc is missing."""
    status = Path(f"/proc/{pid}/status")
    found = re.search(r"VmRSS:\s+(\d+)", status.read_text()) if status.exists() else None
    return int(found[1]) / 1024 if found else float("nan")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--participants", type=int, default=400)
    parser.add_argument("--at-once", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        database = Path(folder) / "load.sqlite"
        with ServerProcess(database) as server:
            asyncio.run(all_take_part(server.port, 5, 5, given.seed))
            began = time.perf_counter()
            times_ms = asyncio.run(
                all_take_part(server.port, given.participants, given.at_once, given.seed)
            )
            seconds = time.perf_counter() - began
            memory = memory_mb(server.pid)
        with sqlite3.connect(database) as connection:
            query = "SELECT count(*) FROM trials WHERE answered_at IS NOT NULL"
            stored = connection.execute(query).fetchone()[0]
    requests = sum(map(len, times_ms.values()))
    acknowledged = 10 * 5 + len(times_ms["answered"])
    print(f"{given.participants} participants, {given.at_once} at once, {seconds:.1f} s")
    print(f"{given.participants / seconds:.0f} participants/s, {requests / seconds:.0f} requests/s")
    print(f"{acknowledged} answers acknowledged, {stored} stored; server {memory:.0f} MB")
    print(f"{'request':10} {'number':>7} {'p50 ms':>8} {'p95 ms':>8} {'p99 ms':>8}")
    for kind, times in times_ms.items():
        p50, p95, p99 = np.percentile(times, [50, 95, 99])
        print(f"{kind:10} {len(times):7} {p50:8.1f} {p95:8.1f} {p99:8.1f}")
    if stored != acknowledged:
        sys.exit("Some acknowledged answers are not stored.")


if __name__ == "__main__":
    main()
