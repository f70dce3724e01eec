"""The commands that copy a database: backup, restore, export."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

commands = typer.Typer()


@commands.command()
def backup(
    to: Annotated[Path, typer.Option(help="File to write; it must not exist.")],
) -> None:
    """Write the whole database to a new file, also while the study runs.

    Example: goalguess backup --to backup.sqlite
    """
    from app.backup import back_up
    from app.settings import load_settings

    settings = load_settings()
    _warn(settings.database_file, "GOALGUESS_DATABASE_URL")
    with _progress("Copying") as progress:
        holds = back_up(settings.database_file, to, progress)
    typer.echo(f"{to}: {holds}, whole and checked.")
    if settings.withdrawals_file.exists():
        typer.echo(
            f"Not in it is the list of who withdrew: keep {settings.withdrawals_file} too, by "
            "which restore leaves them out.",
            err=True,
        )


@commands.command()
def restore(
    file: Annotated[Path, typer.Argument(help="A backup of the database.")],
) -> None:
    """Put a backup in the place of the database that GOALGUESS_DATABASE_URL names.

    Stop the server first. Who is on the list of withdrawals is left out; what is replaced is kept
    under another name.

    Example: goalguess restore backup.sqlite
    """
    from app.backup import restore as put_in_place
    from app.settings import load_settings
    from app.study import load_study

    settings = load_settings()
    _warn(file)
    with _progress("Copying") as progress:
        restored = put_in_place(load_study(settings), file, progress)
    typer.echo(f"{settings.database_file}: {restored.holds}, as in {file}.")
    listed = settings.withdrawals_file
    if listed.exists():
        typer.echo(f"Left out by {listed}, as they have withdrawn since: {restored.dropped}.")
    _warn_of_no_list(listed)
    if restored.replaced:
        held = restored.replaced_holds or "nothing that can be read"
        typer.echo(
            f"What was there is now {restored.replaced}: {held}. Whoever came after the backup is "
            "in it alone, also if they are to be paid. It holds personal data: delete it, and the "
            "files beside it that begin so, when you need it no more."
        )


@commands.command()
def export(
    to: Annotated[Path, typer.Option(help="Folder to write to; made if need be.")],
    simulated: Annotated[
        bool, typer.Option("--simulated", help="Also simulated and preview participants.")
    ] = False,
) -> None:
    """Write trials, participants, events (CSV, JSON lines, Parquet) and the code book.

    Example: goalguess export --to results
    """
    from app.backup import snapshot
    from app.export import export as write_export
    from app.settings import load_settings
    from app.study import load_study

    settings = load_settings()
    study = load_study(settings)
    _warn(settings.database_file, "GOALGUESS_DATABASE_URL")
    with (
        _progress("Reading") as progress,
        snapshot(study, progress) as database,
    ):
        done = write_export(database, study, to, simulated)
    _warn_of_no_list(settings.withdrawals_file)
    rows = ", ".join(f"{count} {name}" for name, count in done.rows.items())
    typer.echo(f"{to}: {rows}; codebook.md says what each column means.")
    if done.pilots_left_out:
        pilots = "1 pilot" if done.pilots_left_out == 1 else f"{done.pilots_left_out} pilots"
        typer.echo(f"{pilots} left out; --simulated includes them.")


def _warn_of_no_list(listed: Path) -> None:
    """Say that a copy may hold people who have withdrawn since it was made."""
    if not listed.exists():
        typer.echo(
            f"No list of who withdrew ({listed}), so nobody is left out; GOALGUESS_WITHDRAWALS "
            "names another one.",
            err=True,
        )


def _warn(file: Path, named_by: str = "") -> None:
    """Say what is odd about the files of a database that is to be read."""
    from app.copying import oddities
    from app.database_files import expect_database

    expect_database(file, named_by)
    for oddity in oddities(file):
        typer.echo(oddity, err=True)


@contextmanager
def _progress(doing: str) -> Iterator[Callable[[int, int], None]]:
    """Shows how far something is, where somebody watches."""
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bars:
        task = bars.add_task(doing, total=None)
        yield lambda done, of: bars.update(task, completed=done, total=of)
