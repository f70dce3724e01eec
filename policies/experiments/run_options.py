"""What the commands that rerun the paper share: their options, and the bar they show."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Annotated

import typer

Seed = Annotated[int, typer.Option(help="Seed of all that is drawn.")]
Mazes = Annotated[
    Path | None, typer.Option(metavar="DIR", help="Take this folder's mazes (.txt) instead.")
]
Workers = Annotated[int, typer.Option(min=1, help="Processes at work.")]
Out = Annotated[Path, typer.Option(metavar="DIR", help="Folder of results, made if need be.")]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with a run that ended.")]


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[[int, int], None]]:
    """Give a function that shows on stderr how many of all units are done.

    No bar before its first call: what is refused is told in one line.
    """
    from rich.console import Console
    from rich.progress import MofNCompleteColumn, Progress, TimeRemainingColumn

    columns = (*Progress.get_default_columns()[:-1], MofNCompleteColumn(), TimeRemainingColumn())
    bar = Progress(*columns, console=Console(stderr=True))
    task = bar.add_task(what, total=None)
    with ExitStack() as until_done:

        def show(done: int, total: int) -> None:
            if not bar.live.is_started:
                until_done.enter_context(bar)
            bar.update(task, completed=done, total=total)

        yield show
