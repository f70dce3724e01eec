"""What all commands share: one clear line on bad input, and progress where someone looks."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import typer

from .errors import AnalysisError


def run_commands(commands: typer.Typer, name: str) -> None:
    """Run a command line; what the caller can mend is one line on stderr and exit code 2."""
    try:
        sys.exit(commands(prog_name=name, standalone_mode=False))
    except typer.TyperException as wrong_use:
        line = _wrong_use(wrong_use)
    except (AnalysisError, OSError) as error:
        line = one_line(error)
    if line:
        typer.echo(f"goalguess: {line}", err=True)
    sys.exit(2)


def one_line(error: Exception) -> str:
    """What an error says, in one line: the system's ones as `file: reason`, without its codes."""
    text = str(error)
    if isinstance(error, OSError) and error.strerror:
        file = error.filename2 or error.filename
        text = f"{file}: {error.strerror}" if file else error.strerror
    return " ".join(re.sub(r"\[Errno -?\d+\] ", "", text).split())


def _wrong_use(error: typer.TyperException) -> str:
    """Typer's message and where to read on; nothing where it has shown the help itself."""
    message = " ".join(error.format_message().split())
    context = getattr(error, "ctx", None)
    if not message or context is None:
        return message
    return f"{message} (see {context.command_path} --help)"


@contextmanager
def one_line_errors() -> Iterator[None]:
    """Turn an error of ours into one line and exit code 2."""
    try:
        yield
    except AnalysisError as error:
        typer.echo(f"goalguess: {one_line(error)}", err=True)
        raise typer.Exit(2) from error


@contextmanager
def status() -> Iterator[Callable[[str], None]]:
    """Show on the terminal what is being done, and nothing where no one looks."""
    from rich.console import Console

    with Console(stderr=True).status("") as shown:
        yield shown.update


@contextmanager
def counting(doing: str, total: int | None = None) -> Iterator[Callable[[int], None]]:
    """Show on the terminal how many of `total` are done, and nothing where no one looks."""
    from rich.console import Console
    from rich.progress import MofNCompleteColumn, Progress, TimeElapsedColumn

    columns = (*Progress.get_default_columns(), MofNCompleteColumn(), TimeElapsedColumn())
    console = Console(stderr=True)
    with Progress(
        *columns, console=console, transient=True, disable=not console.is_terminal
    ) as progress:
        task = progress.add_task(doing, total=total)
        yield lambda done: progress.advance(task, done)
