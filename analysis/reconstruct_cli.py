"""`goalguess reconstruct`: the tables behind the figures that a paper prints."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from .command_line import one_line_errors, status

if TYPE_CHECKING:
    from .reconstruct import Figures, Reconstructed


def reconstruct(
    chi2: Annotated[str, typer.Option(help="Chi-square on 1 degree of freedom, as printed.")],
    n: Annotated[int, typer.Option(help="Trials in both arms together.")],
    p1: Annotated[str, typer.Option(help="Share correct of the treatment arm, as printed: .85")],
    p2: Annotated[str, typer.Option(help="Share correct of the reference arm, as printed: .70")],
    trials_per_participant: Annotated[
        int | None, typer.Option(help="Only arms of whole participants with so many trials.")
    ] = None,
    yates: Annotated[
        bool, typer.Option("--yates", help="The chi-square has the continuity correction.")
    ] = False,
) -> None:
    """List every 2x2 table that prints these figures.

    Each figure stands for all numbers that round to it, so write its zeros: .70 is .695 to .705.

    Example: goalguess reconstruct --chi2 48.864 --n 1500 --p1 .85 --p2 .70
    --trials-per-participant 10
    """
    with one_line_errors():
        with status() as tell:
            tell("Trying tables")
            from .reconstruct import Figures, printed
            from .reconstruct import reconstruct as find_tables

            figures = Figures(
                printed("chi2", chi2),
                n,
                printed("p1", p1),
                printed("p2", p2),
                trials_per_participant,
                yates,
            )
            found = find_tables(figures)
        typer.echo(_told(figures, found))


def _told(figures: Figures, found: tuple[Reconstructed, ...]) -> str:
    from .reporting.document import Grid
    from .reporting.plain import plain_text

    each = figures.trials_each
    whole = f" in whole participants of {each}" if each else ""
    corrected = " with continuity correction" if figures.yates else ""
    said = (
        f"{len(found) or 'No'} table{'' if len(found) == 1 else 's'} of {figures.n} trials{whole} "
        f"with chi2(1) = {figures.chi2.text}{corrected} and shares of {figures.treatment.text} "
        f"and {figures.reference.text} correct"
    )
    if not found:
        return f"{said}."
    participants = ("participants",) if each else ()
    header = ("treatment", "reference", "shares", *participants, "chi2", "p")
    rows = tuple(_row(result, each) for result in found)
    return plain_text([Grid(f"{said}:", header, rows)]).rstrip()


def _row(result: Reconstructed, trials_each: int | None) -> tuple[str, ...]:
    arms = result.table.arms
    return (
        *(f"{arm.count} of {arm.n}" for arm in arms),
        " / ".join(f"{100 * arm.share:.2f} %" for arm in arms),
        *([" + ".join(str(arm.n // trials_each) for arm in arms)] if trials_each else []),
        f"{result.chi2:.6f}",
        f"{result.p:.3g}",
    )
