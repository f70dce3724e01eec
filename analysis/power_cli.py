"""`goalguess power`: how many participants a study needs, by simulation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .command_line import counting, one_line_errors

if TYPE_CHECKING:
    from .power import Power

_TESTS = {
    "correct": {"two_way": "two_way_difference", "mixed": "crossed_logistic"},
    "confidence": {"two_way": "two_way_auc"},
}
"""The report's tests of each measure, by their short names."""


def power(
    measure: Annotated[
        str, typer.Option(metavar="correct|confidence", help="What the arms are compared in.")
    ] = "correct",
    p1: Annotated[
        float, typer.Option(help="Share correct in the treatment arm, for correct.")
    ] = 0.85,
    p2: Annotated[
        float, typer.Option(help="Share correct in the reference arm, for correct.")
    ] = 0.70,
    auc: Annotated[
        float, typer.Option(help="Chance of more in the treatment arm, ties half, for confidence.")
    ] = 0.546,
    sds: Annotated[
        str, typer.Option(help="SDs of participant/scenario/scenario x condition, in logits.")
    ] = ".8/.8/.4",
    tests: Annotated[
        str, typer.Option(metavar="two_way,mixed", help="Which tests; mixed is for correct only.")
    ] = "two_way",
    participants: Annotated[
        str | None,
        typer.Option(
            metavar="N,N,...", help="Both arms together; without it, looks for 80 and 90 %."
        ),
    ] = None,
    trials: Annotated[int, typer.Option(help="Trials of each participant.")] = 10,
    scenarios: Annotated[int, typer.Option(min=2, help="Scenarios they are drawn from.")] = 37,
    simulations: Annotated[int, typer.Option(min=1, help="Studies for each number.")] = 2000,
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same table.")] = 2209,
    workers: Annotated[int, typer.Option(min=1, help="Processes at work.")] = 2,
    to: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write power.json, .csv, .svg and .png here.")
    ] = None,
) -> None:
    """Say how many participants a study needs: simulate it and count how often tests find.

    The tests are the report's own, each by itself at p < .05. The report corrects its primary
    tests for one another by Holm's method, so it finds no more often. Trials come from participants
    crossed with scenarios, on the logit scale; p1 and p2, or auc, hold over all people and
    scenarios together. The mixed model takes a hundred times as long as the two-way test.

    Example: goalguess power --p1 .80 --p2 .70 --participants 80,120,160 --to power
    """
    with one_line_errors():
        from .crossed_model import confidence_model, correct_model
        from .power import PowerQuestion, power_at, search_power
        from .simulation_options import read_names, read_sizes, read_spread

        measure = read_names("--measure", measure, _TESTS)[0]
        known = _TESTS[measure]
        spread = read_spread(sds)
        question = PowerQuestion(
            correct_model(spread, p1, p2)
            if measure == "correct"
            else confidence_model(spread, auc),
            tuple(known[name] for name in read_names("--tests", tests, known)),
            trials,
            scenarios,
            simulations,
            seed,
        )
        sizes = read_sizes(participants) if participants else ()
        total = len({*sizes}) * simulations or None
        with counting("Simulating studies", total) as tell:
            if sizes:
                found = power_at(question, sizes, workers, tell)
            else:
                found = search_power(question, workers, tell)
        typer.echo(_told(found))
        if to is not None:
            from .power_report import write_power

            write_power(found, to)
            typer.echo(f"Written: {to / 'power.json'}, .csv, .svg, .png", err=True)


def _told(power: Power) -> str:
    from .power import UNCORRECTED
    from .reporting.document import Grid, Items, Paragraph
    from .reporting.plain import plain_text
    from .wording import words_of_test

    rows = tuple(
        (
            words_of_test(point.result.test),
            str(point.participants),
            str(point.result.rejected.n),
            f"{100 * point.result.rejected.share:.1f} %",
            f"{100 * point.result.rejected.low:.1f} to {100 * point.result.rejected.high:.1f} %",
            str(point.result.undefined),
        )
        for point in power.points
    )
    header = ("test", "participants", "studies", "power", "95 % Monte-Carlo", "not testable")
    question = power.question
    caption = (
        f"Power for {question.model.measure}: {question.trials_each} trials of each participant, "
        f"{question.scenarios} scenarios, p < .05 uncorrected"
    )
    needed = tuple(
        f"{words_of_test(each.test)}, {100 * each.power:g} %: "
        + (
            f"{each.participants} participants"
            if each.participants
            else f"not between {power.points[0].participants} and "
            f"{power.points[-1].participants} participants"
        )
        for each in power.needed
    )
    table = Grid(caption, header, rows)
    return plain_text([table, Items(needed), Paragraph(UNCORRECTED)]).rstrip()
