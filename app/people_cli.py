"""Commands about people by their recruiter's id: who is to be paid, who asks to be deleted."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:  # the command line reads this file for its help, and must answer fast
    from app.study import Study

commands = typer.Typer()


@commands.command()
def recruits(
    csv: Annotated[
        Path | None, typer.Option("--csv", help="File to write instead, for its owner alone.")
    ] = None,
) -> None:
    """List who is to be paid: the recruiter's ids, how each one ended, and with which code.

    Real participants only. Who withdrew is not among them: nothing is kept of their ids.

    Example: goalguess recruits --csv to-be-paid.csv
    """
    from app.backup import snapshot
    from app.recruits import as_csv, as_table, people_without_id, write_private
    from app.recruits import recruits as find_recruits

    study = _study_in_use()
    with snapshot(study) as database:
        people = database.read_now(lambda connection: find_recruits(connection, study))
        without_id = database.read_now(people_without_id)
    if csv:
        write_private(csv, as_csv(people))
        typer.echo(f"{csv}: {len(people)} recruits.")
    elif people:
        typer.echo(as_table(people))
    else:
        typer.echo("No participant with a recruiter's id has given consent.")
    if without_id:
        typer.echo(without_id, err=True)


@commands.command()
def withdraw(
    recruiter_id: Annotated[
        str, typer.Option(help="The id by which the recruiter knows who asks.")
    ],
) -> None:
    """Delete all that is known of somebody who asks for it by letter, pilots of theirs included.

    Also from a closed study, from those who have finished, and while a server runs.

    Example: goalguess withdraw --recruiter-id 5f1e0c2a9b3d4e6f7a8b9c0d
    """
    import asyncio
    from contextlib import closing

    from app.enrolment import withdraw_recruited
    from app.errors import InvalidInput
    from app.opening import open_database
    from app.recruiter_ids import trimmed

    study, wanted = _study_in_use(), trimmed(recruiter_id)
    with closing(open_database(study, serving=False)) as database:
        count = database.submit(lambda c: withdraw_recruited(c, study, wanted)).result()
        if not count:
            raise InvalidInput(
                "--recruiter-id: expected an id that is stored in "
                f"{study.settings.database_file}, found nobody with this one"
            )
        forgotten = asyncio.run(database.forget_deleted())
    people = "1 participant" if count == 1 else f"{count} participants"
    typer.echo(f"{people} withdrawn: all that was known of them is deleted.")
    if not forgotten:
        typer.echo(
            "While something reads an older state, such as a backup, the database's log still has "
            "traces of them. They go with the next start of the study.",
            err=True,
        )


def _study_in_use() -> "Study":
    """The study of the settings; its database must exist."""
    from app.database_files import expect_database
    from app.settings import load_settings
    from app.study import load_study

    settings = load_settings()
    expect_database(settings.database_file, "GOALGUESS_DATABASE_URL")
    return load_study(settings)
