"""The commands of the decision science: `solve`, `stimuli` and the paper's simulations."""

import json
import math
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from policies.command_line import one_clear_line, write_whole
from policies.errors import StimulusError
from policies.experiments.compare_cli import compare
from policies.experiments.teach_cli import teach

if TYPE_CHECKING:
    from policies.polmdp import LegiblePlan

SEED = 2209
"""The seed of the committed pool: the number of the paper's preprint."""

commands = typer.Typer(
    no_args_is_help=True, add_completion=False, help="Plan legible policies and keep the stimuli."
)
stimuli = typer.Typer(no_args_is_help=True, help="Build, prove and look at the pool of stimuli.")
commands.add_typer(stimuli, name="stimuli")
commands.command()(compare)
commands.command()(teach)

DATA = Path(__file__).parent / "stimuli"
PACKAGE = "the package's own"


@commands.command()
def solve(
    maze: Annotated[Path, typer.Argument(metavar="MAZE.txt", help="A maze text file.")],
    goal: Annotated[str, typer.Option(help="Letter of the goal.")],
    beta: Annotated[float, typer.Option(help="Inverse temperature of the posterior.")] = 0.5,
    gamma: Annotated[float, typer.Option(help="Discount, from 0 to below 1.")] = 0.9,
    formulation: Annotated[
        str, typer.Option(metavar="reward|cost", help="The paper's, or the one sure to arrive.")
    ] = "reward",
    variant: Annotated[
        str,
        typer.Option(
            metavar="as_printed|proper_posterior|advantage", help="What the posterior weighs."
        ),
    ] = "as_printed",
    actions: Annotated[
        str, typer.Option(metavar="udlr|udlrn", help="Four moves, or with standing still.")
    ] = "udlrn",
    prior: Annotated[
        str | None,
        typer.Option(
            metavar="A=.5,B=.3,...",
            help="What the observer believes of every goal beforehand: weights, divided by their "
            "sum. Uniform if left out.",
        ),
    ] = None,
    guard: Annotated[
        bool, typer.Option("--guard", help="Shortest-path actions where it would not arrive.")
    ] = False,
    json_file: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Write all arrays here.")
    ] = None,
) -> None:
    """Solve a maze: arrow maps of the optimal and the legible policy, and what is proved of it.

    Example: goalguess solve maze.txt --goal A --json solved.json
    """
    with one_clear_line():
        from policies.drawing import LEGEND, describe, draw_plan, in_encoding
        from policies.maze import ACTION_SETS
        from policies.maze_files import read_maze
        from policies.polmdp import Parameters, plan_legible
        from policies.priors import goal_prior, parse_weights

        given: dict[str, Any] = {
            "formulation": formulation,
            "variant": variant,
            "actions": actions,
            "guard": guard,
        }
        parameters = Parameters(beta, gamma, **given)
        world = read_maze(maze)
        believed = goal_prior(world, parse_weights(prior)) if prior is not None else None
        plan = plan_legible(world, goal, parameters, believed)
        if json_file:
            write_whole({json_file: json.dumps(_as_json(plan)) + "\n"})
        columns = shutil.get_terminal_size().columns
        maps = draw_plan(plan, ACTION_SETS[parameters.actions], columns)
        text = "\n".join([maps, LEGEND, *describe(plan)])
        typer.echo(in_encoding(text, sys.stdout.encoding))


@stimuli.command()
def build(
    seed: Annotated[int, typer.Option(help="Seed of every draw and of the choice.")] = SEED,
    to: Annotated[Path, typer.Option(help="Folder, made if need be.", show_default=PACKAGE)] = DATA,
) -> None:
    """Build the pool's files from the mazes and a seed: the same bytes each time.

    Example: goalguess stimuli build --seed 2209
    """
    with one_clear_line():
        from policies.pool_build import build as build_pool

        to.mkdir(parents=True, exist_ok=True)
        texts = build_pool(seed, progress=lambda doing: typer.echo(f"{doing} ...", err=True))
        write_whole({to / name: text for name, text in texts.items()})
        typer.echo(f"wrote {' and '.join(texts)} to {to}")


@stimuli.command()
def check(
    folder: Annotated[
        Path, typer.Argument(help="Folder of the pool's files.", show_default=PACKAGE)
    ] = DATA,
) -> None:
    """Prove every rule of the manifest on the pool's files.

    Example: goalguess stimuli check
    """
    with one_clear_line():
        from policies.pool_check import check as check_pool

        check_pool(folder, progress=lambda proved: typer.echo(f"ok  {proved}"))


@stimuli.command()
def show(
    name: Annotated[str, typer.Argument(metavar="ID", help="A stimulus or a scenario.")],
) -> None:
    """Draw a stimulus, or both of a scenario: path, order and an observer's beliefs.

    Example: goalguess stimuli show s01
    """
    with one_clear_line():
        from policies.drawing import draw_beliefs, draw_path
        from policies.pool import load_pool
        from policies.pool_build import beliefs, package_mazes

        pool, mazes = load_pool(), package_mazes()
        known = (*pool.stimuli.values(), pool.practice)
        asked = [s for s in known if name in (s.id, s.scenario)]
        if not asked:
            raise StimulusError(
                f"expected a stimulus or scenario of the pool, {pool.scenarios[0].id} to "
                f"{pool.scenarios[-1].id} or practice; came {name!r}"
            )
        for s in sorted(asked, key=lambda s: s.condition, reverse=True):
            typer.echo(
                f"stimulus {s.id}: scenario {s.scenario}, {s.condition}, maze {s.maze}, "
                f"goal {s.goal}, {s.steps} steps\n"
            )
            typer.echo(draw_path(mazes[s.maze], s.cells) + "\n")
            table = beliefs(mazes[s.maze], s.cells)
            typer.echo(draw_beliefs(mazes[s.maze], s.cells, table, s.goal) + "\n")


@stimuli.command()
def sheet(
    to: Annotated[Path, typer.Option(help="File to write: .svg, .png or .pdf.")],
) -> None:
    """Draw the whole pool on one page: paths and belief curves of every scenario.

    Example: goalguess stimuli sheet --to pool.svg
    """
    with one_clear_line():
        from policies.pool_sheet import FORMATS, draw_sheet

        if to.suffix not in FORMATS:
            raise StimulusError(f"expected a file ending in {', '.join(FORMATS)}; came {to}")
        if not to.parent.is_dir():
            raise StimulusError(f"{to}: expected a file in a folder that exists")
        typer.echo("drawing ...", err=True)
        write_whole({to: draw_sheet(to.suffix)})
        typer.echo(f"wrote {to}")


def _as_json(plan: "LegiblePlan") -> dict[str, Any]:
    """The arrays of a plan: prior by goal; q and r_leg by goal, state, action; others by state."""
    return {
        "goals": list(plan.maze.letters),
        "prior": plan.prior.tolist(),
        "q": plan.q.tolist(),
        "r_leg": plan.r_leg.tolist(),
        "v_legible": plan.v_legible.tolist(),
        "policy_optimal": plan.policy_optimal.tolist(),
        "policy_legible": plan.policy_legible.tolist(),
        "reaches_goal": plan.certificate.reaches_goal.tolist(),
        "arrives": plan.certificate.arrives.tolist(),
        "stretch": [s if math.isfinite(s) else None for s in plan.certificate.stretch.tolist()],
    }
