"""`goalguess teach`: rerun the paper's experiment with inverse reinforcement learners (4.3)."""

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated, Any

import typer

from policies.command_line import one_clear_line

teach = typer.Typer(
    no_args_is_help=True, help="Two teachers, one learner: how soon is the goal named?"
)

Workers = Annotated[int, typer.Option(min=1, help="Processes at work.")]
Seed = Annotated[int, typer.Option(help="Seed of starts, sets, lessons and lots.")]
Predictor = Annotated[str, typer.Option(metavar="gradient|bayes", help="How the learner guesses.")]
Eta = Annotated[float, typer.Option(help="The learner's confidence in the teacher.")]
Out = Annotated[Path, typer.Option(metavar="DIR", help="Folder of results, made if need be.")]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with a run that ended.")]
Mazes = Annotated[
    Path | None, typer.Option(metavar="DIR", help="Take this folder's mazes (.txt) instead.")
]
FOLDER = Path("teaching")


@teach.command()
def sequences(
    starts: Annotated[int, typer.Option(help="Random starts in each maze.")] = 250,
    workers: Workers = 2,
    seed: Seed = 2209,
    predictor: Predictor = "bayes",
    eta: Eta = 10.0,
    out: Out = FOLDER,
    resume: Resume = False,
    mazes: Mazes = None,
) -> None:
    """Lessons are the teachers' ways from a start: 10 ways of 20 steps to each goal.

    Example: goalguess teach sequences --starts 50 --out teaching
    """
    _run(
        workers,
        out,
        resume,
        mazes,
        lessons="sequences",
        units=starts,
        predictor=predictor,
        eta=eta,
        seed=seed,
    )


@teach.command()
def samples(
    sets: Annotated[int, typer.Option(help="Sets of random states in each maze.")] = 250,
    workers: Workers = 2,
    seed: Seed = 2209,
    predictor: Predictor = "bayes",
    eta: Eta = 10.0,
    out: Out = FOLDER,
    resume: Resume = False,
    mazes: Mazes = None,
) -> None:
    """Lessons are one action in each of 20 random states, for each goal.

    Example: goalguess teach samples --predictor gradient --sets 50
    """
    _run(
        workers,
        out,
        resume,
        mazes,
        lessons="samples",
        units=sets,
        predictor=predictor,
        eta=eta,
        seed=seed,
    )


def _run(workers: int, out: Path, resume: bool, mazes: Path | None, **design: Any) -> None:
    with one_clear_line(), ExitStack() as until_done:
        from rich.console import Console
        from rich.progress import Progress

        from policies.experiments.teaching import TeachingDesign, classroom_mazes, run_teaching
        from policies.experiments.teaching_report import publish_teaching
        from policies.maze import read_mazes

        asked = TeachingDesign(**design)
        bar = Progress(console=Console(stderr=True))
        task = bar.add_task("Teaching", total=None)

        def show(done: int, total: int) -> None:
            # Not before the first call: what is refused is told in one line, without a bar.
            if not bar.live.is_started:
                until_done.enter_context(bar)
            bar.update(task, completed=done, total=total)

        rooms = read_mazes(mazes) if mazes else classroom_mazes()
        file = run_teaching(asked, rooms, out, workers, resume=resume, progress=show)
        until_done.close()
        typer.echo(publish_teaching(file, asked))
        typer.echo(f"Rows, tables and figure: {out}", err=True)
