"""What a watcher asks every second: can answers be stored, is there room, which version runs."""

import asyncio
import shutil
from pathlib import Path

from sqlalchemy.exc import SQLAlchemyError
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from app import VERSION
from app.database import Database
from app.deps import as_json, services
from app.errors import AppError

PATIENCE_S = 2.0
LEAST_FREE_MB = 100
"""A study of 1,000 participants takes about as much."""


async def health(request: Request) -> Response:
    """200 if answers can be stored, else 503."""
    at = services(request)
    folder = at.study.settings.database_file.absolute().parent
    writable, free_mb = await _writable(at.database), _free_mb(folder)
    well = writable and free_mb >= LEAST_FREE_MB
    state = {
        "status": "ok" if well else "failing",
        "version": VERSION,
        "database_writable": writable,
        "disk_free_mb": free_mb,
    }
    return as_json(state, 200 if well else 503)


async def _writable(database: Database) -> bool:
    """Whether an empty transaction comes through the queue of all writes and gets their lock."""
    try:
        await asyncio.wait_for(database.write(lambda _connection: None), PATIENCE_S)
    except (SQLAlchemyError, AppError, TimeoutError):
        return False
    return True


def _free_mb(folder: Path) -> int:
    """Room on the database's disk, MB; none where its folder is gone."""
    try:
        return shutil.disk_usage(folder).free // 1_000_000
    except OSError:
        return 0


routes = [Route("/health", health)]
