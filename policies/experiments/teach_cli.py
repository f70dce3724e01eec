"""`goalguess teach`: rerun the paper's experiment with inverse reinforcement learners (4.3)."""

from pathlib import Path
from typing import Annotated, Any

import typer

from policies.command_line import one_clear_line
from policies.experiments.run_options import Mazes, Out, Resume, Seed, Workers, progress_bar


def teach(
    lessons: Annotated[
        str,
        typer.Argument(
            metavar="sequences|samples",
            help="10 ways of 20 steps from a start, or one action in each of 20 random states.",
        ),
    ],
    units: Annotated[
        int,
        typer.Option("--starts", "--sets", help="Random starts, or sets of states, in each maze."),
    ] = 250,
    predictor: Annotated[
        str, typer.Option(metavar="gradient|bayes", help="How the learner guesses.")
    ] = "bayes",
    eta: Annotated[float, typer.Option(help="The learner's confidence in the teacher.")] = 10.0,
    seed: Seed = 2209,
    mazes: Mazes = None,
    workers: Workers = 2,
    out: Out = Path("teaching"),
    resume: Resume = False,
) -> None:
    """Let two teachers show each goal to a learner: how soon is it named? Tables and a figure.

    Example: goalguess teach samples --predictor gradient --sets 50
    """
    with one_clear_line():
        from policies.experiments.teaching import (
            TeachingDesign,
            classroom_mazes,
            run_teaching,
            unteachable,
        )
        from policies.experiments.teaching_report import publish_teaching
        from policies.maze_files import read_mazes

        given: dict[str, Any] = {"lessons": lessons, "predictor": predictor}
        design = TeachingDesign(units=units, eta=eta, seed=seed, **given)
        rooms = read_mazes(mazes, unteachable) if mazes else classroom_mazes()
        with progress_bar("Teaching") as show:
            file = run_teaching(design, rooms, out, workers, resume=resume, progress=show)
        typer.echo(publish_teaching(file, design))
        typer.echo(f"Rows, tables and figure: {out}", err=True)
