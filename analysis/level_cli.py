"""`goalguess level`: the tests' type I error, by simulation."""

from __future__ import annotations

from dataclasses import astuple
from typing import TYPE_CHECKING, Annotated

import typer

from .command_line import counting, one_line_errors

if TYPE_CHECKING:
    from .crossed_model import Design
    from .level_check import LevelTable

_TESTS = (
    "chi_square",
    "gee_logistic",
    "crossed_logistic",
    "two_way_difference",
    "mann_whitney",
    "two_way_auc",
)


def level(
    sds: Annotated[
        str,
        typer.Option(
            help="SDs of participant/scenario/scenario x condition, in logits; log rates of stops."
        ),
    ] = "0/0/0,.5/0/0,1/0/0,.8/.8/.4,.8/.5/.8",
    tests: Annotated[str, typer.Option(metavar="TEST,TEST,...", help="Tests to check.")] = ",".join(
        _TESTS
    ),
    replicates: Annotated[
        int, typer.Option(min=1, help="Simulated studies for each of the SDs.")
    ] = 2000,
    participants: Annotated[
        str,
        typer.Option(metavar="N|N/M", help="Both arms together, or the treatment's/the other's."),
    ] = "150",
    trials: Annotated[int, typer.Option(help="Trials of each participant.")] = 10,
    scenarios: Annotated[
        int, typer.Option(help="Scenarios; where trials are more, everybody sees some again.")
    ] = 37,
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same table.")] = 2209,
    workers: Annotated[int, typer.Option(min=1, help="Processes at work.")] = 2,
) -> None:
    """Count how often tests find a difference in simulated studies that have none: 5 % is right.

    Participants and scenarios differ, the conditions do not. With these tests it takes an hour; the
    mixed model (crossed_logistic) takes most of it. There are also crossed_ordinal,
    two_way_auc_of_correct, two_way_difference_of_confidence, and cox and two_way_cox of the time to
    a correct stop.

    Example: goalguess level --sds .8/.5/.8 --tests two_way_difference --participants 8/32
    """
    with one_line_errors():
        from .crossed_model import Design
        from .level_check import level_check
        from .simulated_studies import TESTS, by_measure
        from .simulation_options import read_arms, read_names, read_spreads

        known = [test for own in TESTS.values() for test in own]
        spreads, names = read_spreads(sds), read_names("--tests", tests, known)
        design = Design(*read_arms(participants), trials, scenarios)
        total = len(spreads) * len(by_measure(names)) * replicates
        with counting("Simulating studies", total) as tell:
            table = level_check(spreads, names, design, replicates, seed, workers, tell)
        typer.echo(_told(table, design))


def _told(table: LevelTable, design: Design) -> str:
    from .reporting.document import Grid, Paragraph
    from .reporting.plain import plain_text
    from .simulated_studies import ALPHA
    from .wording import words_of_test

    header = ("test", *("/".join(f"{sd:g}" for sd in astuple(each)) for each in table.spreads))
    rows = tuple(
        (words_of_test(test), *(f"{each.rejected.share:.3f}" for each in row))
        for test, row in table.rows.items()
    )
    caption = (
        f"Share of {table.studies} studies with p < .05, {design.treatment} + {design.reference} "
        f"participants with {design.trials_each} trials each of {design.scenarios} scenarios, by "
        "SDs of participant/scenario/scenario x condition"
    )
    low, high = ALPHA - table.monte_carlo_error, ALPHA + table.monte_carlo_error
    note = (
        f"Monte-Carlo error: a test that holds its level is between {low:.3f} and {high:.3f} in "
        "95 % of such simulations."
    )
    undefined = {
        words_of_test(test): sum(each.undefined for each in row) for test, row in table.rows.items()
    }
    without = [f"{count} of {test}" for test, count in undefined.items() if count]
    if without:
        note += f" Studies in which a test had no p, counted as no rejection: {', '.join(without)}."
    return plain_text([Grid(caption, header, rows), Paragraph(note)]).rstrip()
