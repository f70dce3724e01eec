"""What all commands share: one clear line on bad input, and progress where someone looks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import typer

from .errors import AnalysisError


@contextmanager
def one_line_errors() -> Iterator[None]:
    """Turn an error of ours into one line and exit code 2."""
    try:
        yield
    except AnalysisError as error:
        typer.echo(f"goalguess: {' '.join(str(error).split())}", err=True)
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
