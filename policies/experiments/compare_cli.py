"""`goalguess compare`: rerun the paper's comparison of frameworks (4.2)."""

from pathlib import Path
from typing import Any

import typer

import policies.experiments.compare_options as options
from policies.command_line import one_clear_line
from policies.experiments.run_options import Mazes, Out, Resume, Seed, Workers, progress_bar


def compare(
    test: options.Test = None,
    preset: options.Preset = None,
    pairs: options.Pairs = None,
    pairs_file: options.PairsFile = None,
    simulations: options.Simulations = 10_000,
    limit: options.Limit = 60.0,
    mode: options.Mode = None,
    beta: options.Beta = None,
    gamma: options.Gamma = None,
    variants: options.Variants = None,
    formulation: options.Formulation = None,
    guard: options.Guard = None,
    distance: options.Distance = None,
    observer_beta: options.ObserverBeta = None,
    actions: options.Actions = None,
    most_moves: options.MostMoves = None,
    seed: Seed = 2209,
    mazes: Mazes = None,
    workers: Workers = 2,
    dask: options.Dask = None,
    out: Out = Path("comparison"),
    resume: Resume = False,
) -> None:
    """Let PoLMDP, L-MDP and the optimal policy play the same pairs; tables, figures, a reading.

    Example: goalguess compare states --pairs 20 --simulations 1000

    Example: goalguess compare --preset authors --mazes DIR --pairs-file pairs.csv
    """
    chosen: dict[str, Any] = {
        "pairs": pairs,
        "mode": mode,
        "beta": beta,
        "gamma": gamma,
        "variants": variants,
        "formulation": formulation,
        "guard": guard,
        "distance": distance,
        "observer_beta": observer_beta,
        "actions": actions,
        "most_moves": most_moves,
    }
    chosen = {name: choice for name, choice in chosen.items() if choice is not None}
    settled: dict[str, Any] = {
        "test": test,
        "simulations": simulations,
        "limit_s": limit,
        "seed": seed,
    }
    with one_clear_line():
        from policies.errors import ModelError
        from policies.experiments.comparison import design_comparison
        from policies.experiments.pairs_file import with_listed_pairs
        from policies.experiments.publish import publish_comparison
        from policies.experiments.scaling import compare_frameworks, open_comparison
        from policies.experiments.worlds import drawn_worlds, read_worlds

        if pairs_file:
            if pairs is not None:
                raise ModelError("expected either --pairs or --pairs-file, came both")
            chosen["pairs"] = None
        comparison = design_comparison(preset, **chosen, **settled)
        if mazes:
            worlds = read_worlds(mazes)
        elif comparison.test:
            worlds = drawn_worlds(comparison.test, seed)
        else:
            raise ModelError("expected goals or states, or --mazes DIR; came none of them")
        if pairs_file:
            worlds = with_listed_pairs(worlds, pairs_file)
        store = open_comparison(out, worlds, comparison, resume=resume)
        with progress_bar("Playing pairs") as show:
            compare_frameworks(worlds, comparison, store, workers, dask, show)
        typer.echo(publish_comparison(store.file, comparison))
        typer.echo(f"Tables, figures and this text: {out}", err=True)
