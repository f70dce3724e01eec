"""What all commands share: one clear line on bad input, files written whole or not at all."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import typer

from policies.errors import PolicyError


@contextmanager
def one_clear_line() -> Iterator[None]:
    """Turn what the caller can mend into one line on stderr and exit code 2."""
    try:
        yield
    except BrokenPipeError:  # the reader of our output has left; typer ends quietly
        raise
    except (PolicyError, OSError) as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(2) from error


def write_whole(contents: dict[Path, str | bytes]) -> None:
    """Write files whole or not at all: each beside its place first, then moved there."""
    ready: list[tuple[str, Path]] = []
    try:
        for path, content in contents.items():
            with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as file:
                ready.append((file.name, path))
                file.write(content.encode() if isinstance(content, str) else content)
            Path(file.name).chmod(0o644)
        for beside, path in ready:
            Path(beside).replace(path)
    finally:
        for beside, _ in ready:
            Path(beside).unlink(missing_ok=True)
