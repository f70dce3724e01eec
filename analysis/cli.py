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
            metavar="DIR",
            help="Write the report (HTML, Markdown, JSON, APA sentences) and its figures there.",
        ),
    ] = None,
    plan: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Plan of the analysis, TOML; else the default plan."),
    ] = None,
    mapping: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="What a table from elsewhere calls its columns, TOML."),
    ] = None,
    simulated: Annotated[
        bool, typer.Option("--simulated", help="Include simulated and preview participants.")
    ] = False,
) -> None:
    """Compare the conditions of a study: the answers to its hypotheses, and the paper's statistics.

    The primary tests take participants and scenarios as random; the paper's tests stand beside
    them. Prints the answers; with --to writes the whole report with tables and figures.

    Example: goalguess analyse export/ --to report/
    """
    with one_line_errors(), status() as tell:
        tell("Loading the statistics")
        from .mapping import read_mapping
        from .plan import read_plan
        from .publish import write_report
        from .reporting.plain import plain_text
        from .reporting.report import brief_parts
        from .results import analyse_path

        tell(f"Reading {path}")
        results = analyse_path(
            path,
            read_plan(plan) if plan else None,
            read_mapping(mapping) if mapping else None,
            with_simulated=simulated,
        )
        if to is not None:
            write_report(results, to, tell)
        text = plain_text(brief_parts(results))
    typer.echo(text)
    if to is None:
        typer.echo("Add --to DIR for the whole report with tables and figures.", err=True)
    else:
        typer.echo(f"Written: {to / 'report.html'}, .md, .json, apa.txt, figures/", err=True)


commands.command()(power)
commands.command()(level)
commands.command()(reconstruct)
