"""Run the analysis without the rest of Goalguess: python -m analysis analyse PATH."""

import typer

from .cli import commands
from .command_line import run_commands

alone = typer.Typer(no_args_is_help=True, add_completion=False)
alone.add_typer(commands)


@alone.callback()
def main() -> None:
    """Statistics of a study made with Goalguess."""


if __name__ == "__main__":
    run_commands(alone, "python -m analysis")
