"""`goalguess compare`: rerun the paper's comparison of frameworks (4.2)."""

from pathlib import Path
from typing import Annotated, Any

import typer

from policies.command_line import one_clear_line
from policies.experiments.run_options import Mazes, Out, Resume, Seed, Workers, progress_bar


def compare(
    test: Annotated[
        str, typer.Argument(metavar="goals|states", help="More goals, or larger mazes.")
    ],
    pairs: Annotated[int, typer.Option(help="Pairs of start and goal in each world.")] = 250,
    simulations: Annotated[int, typer.Option(help="L-MDP's simulations a step.")] = 10_000,
    limit: Annotated[float, typer.Option(help="Seconds that L-MDP has for a pair.")] = 60.0,
    mode: Annotated[
        str, typer.Option(metavar="miura|as_reported", help="L-MDP as published, or as baseline.")
    ] = "miura",
    seed: Seed = 2209,
    mazes: Mazes = None,
    workers: Workers = 2,
    dask: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Work on this dask cluster (its scheduler) instead."),
    ] = None,
    out: Out = Path("comparison"),
    resume: Resume = False,
) -> None:
    """Let PoLMDP, L-MDP and the optimal policy play the same pairs; tables, figures, a reading.

    Example: goalguess compare states --pairs 20 --simulations 1000
    """
    with one_clear_line():
        from policies.experiments.publish import publish_comparison
        from policies.experiments.scaling import Comparison, compare_frameworks, open_comparison
        from policies.experiments.worlds import drawn_worlds, read_worlds

        given: dict[str, Any] = {"test": test, "mode": mode}
        comparison = Comparison(
            pairs=pairs, simulations=simulations, limit_s=limit, seed=seed, **given
        )
        worlds = read_worlds(mazes) if mazes else drawn_worlds(comparison.test, seed)
        store = open_comparison(out, worlds, comparison, resume=resume)
        with progress_bar("Playing pairs") as show:
            compare_frameworks(worlds, comparison, store, workers, dask, show)
        typer.echo(publish_comparison(store.file, comparison))
        typer.echo(f"Tables, figures and this text: {out}", err=True)
