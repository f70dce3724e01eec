"""What tests say of simulated studies, on several cores: the same whatever their number."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any
from zlib import crc32

import joblib
import numpy as np
from numpy.typing import NDArray

from .crossed_model import CrossedModel, Design, simulate
from .simulated_stops import StopsModel, simulate_stops
from .statistics.clustered import two_way_auc, two_way_difference
from .statistics.cox import clustered_cox, two_way_cox
from .statistics.estimates import Share, share
from .statistics.gee import gee_logistic
from .statistics.mixed_model import crossed_logistic
from .statistics.ordinal_mixed import crossed_ordinal
from .statistics.outcome import Outcome
from .statistics.ranks import mann_whitney
from .statistics.result import TestResult
from .statistics.survival import Stops
from .statistics.two_by_two import TwoByTwo, chi_square

ALPHA = 0.05
"""Two-sided."""

Model = CrossedModel | StopsModel
Test = Callable[[Any], TestResult]
"""Takes an Outcome, or the Stops of a `StopsModel`."""

Tell = Callable[[int], None]
"""Is told how many studies more are done."""

_BATCH = 20


def _chi_square_on_trials(outcome: Outcome) -> TestResult:
    treatment, reference = outcome.y[outcome.treated], outcome.y[~outcome.treated]
    correct = [int(arm.sum()) for arm in (treatment, reference)]
    wrong = [len(treatment) - correct[0], len(reference) - correct[1]]
    return chi_square(TwoByTwo(correct[0], wrong[0], correct[1], wrong[1]))


def _mann_whitney_on_trials(outcome: Outcome) -> TestResult:
    return mann_whitney(outcome.y[outcome.treated], outcome.y[~outcome.treated])


TESTS: Mapping[str, Mapping[str, Test]] = {
    "correct": {
        "chi_square": _chi_square_on_trials,
        "gee_logistic": gee_logistic,
        "crossed_logistic": crossed_logistic,
        "two_way_difference": two_way_difference,
        "two_way_auc_of_correct": two_way_auc,
    },
    "confidence": {
        "mann_whitney": _mann_whitney_on_trials,
        "crossed_ordinal": crossed_ordinal,
        "two_way_auc": two_way_auc,
        "two_way_difference_of_confidence": two_way_difference,
    },
    "time_to_correct_stop": {"cox": clustered_cox, "two_way_cox": two_way_cox},
}
"""Tests by the measure they are of, as the report runs them; every primary test of a plan is there.

Those that say of what they are have the plain name on the other measure.
"""


def by_measure(tests: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Group tests by the measure they are of; measures without a test are left out."""
    groups = {measure: tuple(t for t in tests if t in known) for measure, known in TESTS.items()}
    return {measure: own for measure, own in groups.items() if own}


@dataclass(frozen=True)
class Rejections:
    """How often a test found p < `ALPHA`; studies without a p are `undefined` and no rejection."""

    test: str
    rejected: Share
    undefined: int


def rejections(
    model: Model,
    design: Design,
    tests: tuple[str, ...],
    studies: int,
    seed: int,
    workers: int,
    tell: Tell,
) -> tuple[Rejections, ...]:
    """Simulate studies and run every test, of `TESTS` for the model's measure, on each.

    A study's trials depend on seed, design, spreads and its number only, so studies that are
    asked for later add to the same ones.
    """
    key = (seed, crc32(repr((model.measure, model.spread, design)).encode()))
    batches = (range(first, min(first + _BATCH, studies)) for first in range(0, studies, _BATCH))
    run = partial(_p_values, model, design, tests, key)
    parallel = joblib.Parallel(n_jobs=workers, return_as="generator")
    done: Iterator[NDArray[np.float64]] = parallel(joblib.delayed(run)(batch) for batch in batches)
    found = []
    for p in done:
        found.append(p)
        tell(len(p))
    p = np.concatenate(found)
    return tuple(
        Rejections(test, share(int((column < ALPHA).sum()), studies), int(np.isnan(column).sum()))
        for test, column in zip(tests, p.T, strict=True)
    )


def _p_values(
    model: Model,
    design: Design,
    tests: tuple[str, ...],
    key: tuple[int, ...],
    studies: range,
) -> NDArray[np.float64]:
    """Return p of each study and test, NaN where undefined."""
    p = np.full((len(studies), len(tests)), np.nan)
    for row, study in zip(p, studies, strict=True):
        trials = _drawn(model, design, np.random.default_rng((*key, study)))
        row[:] = [TESTS[model.measure][test](trials).p for test in tests]
    return p


def _drawn(model: Model, design: Design, rng: np.random.Generator) -> Outcome | Stops:
    if isinstance(model, StopsModel):
        return simulate_stops(model, design, rng)
    return simulate(model, design, rng)
