"""What all commands share: one clear line on bad input, files written whole or not at all."""

import re
import sys
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import typer

from policies.errors import MazeError, PolicyError


def run_commands(commands: typer.Typer, name: str, refusals: tuple[type[Exception], ...]) -> None:
    """Run a command line; what the caller can mend is one line on stderr and exit code 2."""
    expected: tuple[type[Exception], ...] = (*refusals, OSError)
    try:
        sys.exit(commands(prog_name=name, standalone_mode=False))
    except typer.TyperException as wrong_use:
        lines = [_wrong_use(wrong_use)]
    except expected as error:
        lines = clear_lines(error)
    _show(filter(None, lines))
    sys.exit(2)


def clear_lines(error: Exception) -> list[str]:
    """What an error says, in one line: the system's ones as `file: reason`, without its codes.

    Only of mazes there can be several: each file's faults have a line of their own.
    """
    text = str(error)
    if isinstance(error, OSError) and error.strerror:
        file = error.filename2 or error.filename
        text = f"{file}: {error.strerror}" if file else error.strerror
    texts = text.splitlines() if isinstance(error, MazeError) else [text]
    return [" ".join(re.sub(r"\[Errno -?\d+\] ", "", line).split()) for line in texts]


def _show(lines: Iterable[str]) -> None:
    for line in lines:
        typer.echo(f"goalguess: {line}", err=True)


def _wrong_use(error: typer.TyperException) -> str:
    """Typer's message and where to read on; nothing where it has shown the help itself."""
    message = " ".join(error.format_message().split())
    context = getattr(error, "ctx", None)
    if not message or context is None:
        return message
    return f"{message} (see {context.command_path} --help)"


@contextmanager
def one_clear_line() -> Iterator[None]:
    """Turn what the caller can mend into one line on stderr, or one a bad maze; exit code 2."""
    try:
        yield
    except BrokenPipeError:  # the reader of our output has left; typer ends quietly
        raise
    except (PolicyError, OSError) as error:
        _show(clear_lines(error))
        raise typer.Exit(2) from error


def write_whole(contents: dict[Path, str | bytes]) -> None:
    """Write files whole or not at all: each beside its place first, then moved there.

    OSError names the file that was to be written.
    """
    ready: list[tuple[str, Path]] = []
    try:
        for path, content in contents.items():
            with _told_of(path), tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as file:
                ready.append((file.name, path))
                file.write(content.encode() if isinstance(content, str) else content)
            Path(file.name).chmod(0o644)
        for beside, path in ready:
            with _told_of(path):
                Path(beside).replace(path)
    finally:
        for beside, _ in ready:
            Path(beside).unlink(missing_ok=True)


@contextmanager
def _told_of(path: Path) -> Iterator[None]:
    """Let an error name a file that is written, not the temporary one beside it."""
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from error
