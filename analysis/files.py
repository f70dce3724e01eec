"""Writing files so that a reader never meets half of one."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import AnalysisError


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary path beside `path`, and rename it to `path` when the block succeeds.

    When the block fails, the temporary file goes and an older `path` stays as it was; an OSError
    about the temporary file names `path`.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        yield temporary
        temporary.replace(path)
    except OSError as error:
        if error.filename == str(temporary):
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def folder_for_writing(folder: Path) -> Iterator[Path]:
    """Make `folder` with its parents and turn the system's refusals into an AnalysisError."""
    with refusals_told(folder):
        folder.mkdir(parents=True, exist_ok=True)
        yield folder


@contextmanager
def refusals_told(folder: Path) -> Iterator[None]:
    """Turn the system's refusals in the block into an AnalysisError that names `folder`."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        raise AnalysisError(f"{folder}: expected a folder to write to, got: {reason}") from error
