"""The commands of the analysis: `goalguess analyse`, or `python -m analysis analyse`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .command_line import one_line_errors, status
from .level_cli import level
from .power_cli import power
from .reconstruct_cli import reconstruct

commands = typer.Typer()
"""Without a callback, so that another Typer can take its commands in without a group's name."""


@commands.command()
def analyse(
    path: Annotated[
        Path, typer.Argument(help="Folder made by `goalguess export`, or one file of trials.")
    ],
    to: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR", help="Write report.json, report.md and the figures into this folder."
        ),
    ] = None,
    simulated: Annotated[
        bool, typer.Option("--simulated", help="Include simulated and preview participants.")
    ] = False,
) -> None:
    """Print the paper's statistics for a study, and write them with figures.

    Compares both conditions: correct guesses (chi-square), time of prediction and confidence
    (Mann-Whitney), with normality and demographics.

    Example: goalguess analyse export/ --to report/
    """
    with one_line_errors(), status() as tell:
        tell("Loading the statistics")
        from .document import plain_text
        from .publish import analyse_path, write_report

        tell(f"Reading {path}")
        results = analyse_path(path, with_simulated=simulated)
        if to is not None:
            write_report(results, to, tell)
        text = plain_text(results.parts)
    typer.echo(text)
    if to is None:
        typer.echo("Add --to DIR for report.md, report.json and the figures.", err=True)
    else:
        typer.echo(f"Written: {to / 'report.md'}, report.json, figures/", err=True)


commands.command()(power)
commands.command()(level)
commands.command()(reconstruct)
