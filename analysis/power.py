"""How many participants does a study need? Its power, by simulation with the report's own tests."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from math import ceil

from .crossed_model import CrossedModel, Design, halves
from .power_curve import PowerCurve, fit_power
from .simulated_studies import Rejections, Tell, rejections

TARGETS = (0.8, 0.9)
"""Powers for which the number of participants is told."""
UNCORRECTED = (
    "A study counts as finding where p of the one test is below .05. The report corrects its "
    "plan's primary tests, three by default, for one another by Holm's method, which asks for "
    "p < .05/3 at the strictest: it finds no more often than is told here."
)
"""What this power leaves out, for who reads it."""
SMALLEST, LARGEST = 20, 2560
"""Numbers of participants between which a search looks."""
_PILOT = 4
"""How many times fewer studies are simulated while numbers are doubled."""
_NEAR = 0.03
"""Numbers this close, relatively, are not simulated both."""


@dataclass(frozen=True)
class PowerQuestion:
    """What is simulated: `studies` for each number of participants, each run through `tests`."""

    model: CrossedModel
    tests: tuple[str, ...]
    trials_each: int
    scenarios: int
    studies: int
    seed: int


@dataclass(frozen=True)
class PowerPoint:
    """Simulated power of a test with so many participants, both arms together."""

    participants: int
    result: Rejections


@dataclass(frozen=True)
class Needed:
    """Participants, both arms together, for a power.

    None where the curve does not reach it between the numbers simulated.
    """

    test: str
    power: float
    participants: int | None


@dataclass(frozen=True)
class Power:
    """The answer: simulated points, fewest participants first, and what follows from them."""

    question: PowerQuestion
    points: tuple[PowerPoint, ...]

    def of_test(self, test: str) -> tuple[PowerPoint, ...]:
        """Return the points of one test, fewest participants first."""
        return tuple(point for point in self.points if point.result.test == test)

    def curve(self, test: str) -> PowerCurve:
        """Return the curve through the points of a test."""
        points = self.of_test(test)
        return fit_power(
            [point.participants for point in points],
            [point.result.rejected for point in points],
            self.question.scenarios,
        )

    @property
    def needed(self) -> tuple[Needed, ...]:
        """Numbers of participants for each test and power of `TARGETS`, told where simulated."""
        return tuple(
            Needed(each.test, each.power, each.participants if self.covers(each) else None)
            for each in self.on_the_curve
        )

    @property
    def on_the_curve(self) -> tuple[Needed, ...]:
        """The same by the curves alone, also beyond the numbers simulated."""
        curves = {test: self.curve(test) for test in self.question.tests}
        return tuple(
            Needed(test, target, curve.needed(target))
            for test, curve in curves.items()
            for target in TARGETS
        )

    def covers(self, each: Needed) -> bool:
        """Whether a number lies between those simulated."""
        fewest, most = self.points[0].participants, self.points[-1].participants
        return each.participants is not None and fewest <= each.participants <= most


def power_at(
    question: PowerQuestion, participants: Iterable[int], workers: int, tell: Tell
) -> Power:
    """Simulate the power with given numbers of participants; AnalysisError if one is odd."""
    designs = [halves(n, question.trials_each, question.scenarios) for n in sorted({*participants})]
    points = [_simulated(question, design, question.studies, workers, tell) for design in designs]
    return Power(question, tuple(chain.from_iterable(points)))


def search_power(question: PowerQuestion, workers: int, tell: Tell) -> Power:
    """Look for the numbers of participants that give each test the powers of `TARGETS`.

    Numbers are doubled, with fewer studies, until every test has the largest power; then those
    are simulated at which the curve through all points reaches a power, until it stays near them.
    """
    found: dict[int, tuple[PowerPoint, ...]] = {}

    def simulate(participants: int, studies: int) -> None:
        design = halves(participants, question.trials_each, question.scenarios)
        found[participants] = _simulated(question, design, studies, workers, tell)

    def power() -> Power:
        return Power(question, tuple(chain.from_iterable(found[n] for n in sorted(found))))

    for participants in _doubled():
        simulate(participants, ceil(question.studies / _PILOT))
        if all(point.result.rejected.share > max(TARGETS) for point in found[participants]):
            break
    known: list[int] = []
    while wanted := _still_wanted(power(), known):
        simulate(wanted, question.studies)
        known.append(wanted)
    return power()


def _still_wanted(power: Power, known: Sequence[int]) -> int | None:
    """Return a number of participants that the curves point to and that is not near to one known.

    None if there is none, or only above `LARGEST`.
    """
    for each in power.on_the_curve:
        number = each.participants
        if number is None or number > LARGEST:
            continue
        if not power.covers(each) or not any(abs(number - n) <= _NEAR * n for n in known):
            return number
    return None


def _doubled() -> Iterator[int]:
    participants = SMALLEST
    while participants <= LARGEST:
        yield participants
        participants *= 2


def _simulated(
    question: PowerQuestion, design: Design, studies: int, workers: int, tell: Tell
) -> tuple[PowerPoint, ...]:
    """Simulate the power of every test with one number of participants."""
    results = rejections(
        question.model, design, question.tests, studies, question.seed, workers, tell
    )
    return tuple(PowerPoint(design.participants, result) for result in results)
