"""The command `goalguess`: the study's own commands beside those of policies and analysis."""

from typing import Annotated

import typer

from analysis import commands as analysis_commands
from app.backup_cli import commands as backup_commands
from app.bots.kinds import DEFAULT_MIX, Kind, read_mix
from app.people_cli import commands as people_commands
from app.serve_cli import commands as serve_commands
from policies import commands as policies_commands

commands = typer.Typer(
    name="goalguess",
    help="Show people how an agent acts, and measure how soon they know what it wants.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
commands.add_typer(serve_commands)
commands.add_typer(policies_commands)
commands.add_typer(analysis_commands)
commands.add_typer(backup_commands)
commands.add_typer(people_commands)


@commands.command()
def simulate(
    participants: Annotated[int, typer.Option(min=1, help="How many take part.")] = 150,
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same rows.")] = 1,
    url: Annotated[
        str | None,
        typer.Option(help="Address of a running study; without it, none need be running."),
    ] = None,
    mix: Annotated[
        str, typer.Option(help=f"Kinds and their shares, of: {', '.join(Kind)}.")
    ] = DEFAULT_MIX,
    at_once: Annotated[int, typer.Option(min=1, help="How many are on the way at once.")] = 20,
) -> None:
    """Let simulated participants take the whole study, marked as such in their rows.

    They see what the pages are sent and nothing else: noisy Bayesian observers, among them some
    who guess, drop out, reload, lose the connection, come back or withdraw. Without --url they
    write to the file GOALGUESS_DATABASE_URL names; a new file is dealt from the same seed.

    Example: goalguess simulate --participants 20 --mix attentive=8,dropping_out=1
    """
    from rich.console import Console
    from rich.progress import Progress

    from app.bots.crowd import draw_bots, run
    from app.bots.summary import summary
    from app.settings import load_settings

    bots = draw_bots(participants, seed, read_mix(mix))
    settings = load_settings()
    if settings.seed is None and not settings.database_file.exists():
        settings = settings.model_copy(update={"seed": seed})
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("Taking part", total=len(bots))
        outcomes = run(bots, url or settings, at_once, lambda _outcome: progress.advance(task))
    typer.echo(summary(outcomes))
    typer.echo("goalguess export --simulated --to DIR writes what they left.", err=True)


def main() -> None:
    """Run the command; whatever the user can mend is one line, never a traceback."""
    from analysis import AnalysisError
    from app.errors import AppError
    from policies import PolicyError, run_commands

    run_commands(commands, "goalguess", (AppError, AnalysisError, PolicyError))


if __name__ == "__main__":
    main()
