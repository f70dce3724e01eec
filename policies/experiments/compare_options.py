"""The choices of a comparison as options of its command; None where nobody chose."""

from pathlib import Path
from typing import Annotated

import typer

Test = Annotated[
    str | None,
    typer.Argument(metavar="[goals|states]", help="More goals, or larger mazes."),
]
Preset = Annotated[
    str | None,
    typer.Option(metavar="authors", help="Every choice as the paper's authors made it."),
]
Pairs = Annotated[
    int | None,
    typer.Option(help="Pairs of start and goal drawn in each world.", show_default="250"),
]
PairsFile = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Play the pairs of this CSV instead: maze,row,column,goal, the start's row and "
        "column from 1 at the top left. Mazes that it does not name are not played.",
    ),
]
Simulations = Annotated[int, typer.Option(help="L-MDP's simulations a step.")]
Limit = Annotated[float, typer.Option(help="Seconds that L-MDP has for a pair.")]
Mode = Annotated[
    str | None,
    typer.Option(
        metavar="miura|as_reported",
        help="L-MDP as published, or as baseline.",
        show_default="miura",
    ),
]
Beta = Annotated[
    float | None, typer.Option(help="Inverse temperature of r_leg.", show_default="0.5")
]
Gamma = Annotated[
    float | None,
    typer.Option(help="Discount of all, but of mode as_reported.", show_default="0.9"),
]
Variants = Annotated[
    list[str] | None,
    typer.Option(
        "--variant",
        metavar="as_printed|proper_posterior|advantage|all",
        help="Of r_leg; each is a PoLMDP of its own, and may be told again and again.",
        show_default="as_printed",
    ),
]
Formulation = Annotated[
    str | None,
    typer.Option(metavar="reward|cost", help="What PoLMDP optimises.", show_default="reward"),
]
Guard = Annotated[
    bool | None,
    typer.Option("--guard", help="Repair PoLMDP's policy where it may not arrive."),
]
Distance = Annotated[
    str | None,
    typer.Option(
        metavar="tv|euclid|kl",
        help="Of beliefs, in the L-MDP measure and mode miura.",
        show_default="tv",
    ),
]
ObserverBeta = Annotated[
    float | None,
    typer.Option(help="The observer's inverse temperature there.", show_default="5"),
]
Actions = Annotated[
    str | None,
    typer.Option(metavar="udlr|udlrn", help="Four moves, or no-op too.", show_default="udlr"),
]
MostMoves = Annotated[
    int | None,
    typer.Option(
        help="Who needs more did not arrive.",
        show_default="4 x distance / .85; with mode as_reported 502",
    ),
]
Dask = Annotated[
    str | None,
    typer.Option(metavar="ADDRESS", help="Work on this dask cluster (its scheduler) instead."),
]
