"""Every method by which the arms are compared, by measure; what tables and figures list.

Those that take participants, or participants and scenarios, as random come first; then those that
take trials as independent, as the paper does.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from .dataset import Dataset, outcome
from .plan import Primary
from .statistics.clustered import (
    clustered_auc,
    clustered_difference,
    two_way_auc,
    two_way_difference,
)
from .statistics.estimates import Mean, mean
from .statistics.gee import LARGEST as MOST_PARTICIPANTS_OF_GEE
from .statistics.gee import gee_logistic
from .statistics.influence import cluster_count
from .statistics.mixed_model import crossed_logistic, participant_logistic
from .statistics.ordinal_mixed import crossed_ordinal
from .statistics.outcome import Outcome
from .statistics.participants import by_participant
from .statistics.permutation import cluster_permutation
from .statistics.ranks import (
    brunner_munzel,
    hodges_lehmann,
    mann_whitney,
    mann_whitney_exact_if_few,
)
from .statistics.rao_scott import rao_scott
from .statistics.result import TestResult
from .statistics.superiority import Superiority, superiority
from .statistics.two_by_two import (
    TwoByTwo,
    chi_square,
    fisher_exact,
    g_test,
    odds_ratio,
    risk_difference,
)

MODELS = ("crossed_logistic", "crossed_ordinal")
"""Mixed models, told beside the primary test."""
MOST_TRIALS_OF_MODELS = 50_000


@dataclass(frozen=True)
class Method:
    """A way to compare the arms; tables call it `name`.

    `run` takes all trials with the measure. Above `most_trials` or `most_participants` it would
    take too long, and is left out.
    """

    name: str
    run: Callable[[Outcome], TestResult]
    most_trials: float = math.inf
    most_participants: float = math.inf


@dataclass(frozen=True)
class Comparison:
    """One measure compared by every method, results by the method's key, in the tables' order.

    `means` has the treatment's and the reference's; `left_out` says of methods not run why;
    `superiority` is of correct guesses, None for other measures.
    """

    measure: str
    unit: str
    means: tuple[Mean, Mean]
    primary_key: str
    results: Mapping[str, TestResult]
    left_out: Mapping[str, str]
    superiority: Superiority | None = None

    @property
    def primary(self) -> TestResult:
        """The result of the plan's test."""
        return self.results[self.primary_key]


def compare(data: Dataset, primary: Primary) -> Comparison:
    """Run every method on one measure of the plan; EmptyArmError if an arm has no value."""
    given = outcome(data, primary.measure)
    present = given.present()
    trials, participants = len(present.y), cluster_count(present.participant)
    results, left_out = {}, {}
    for key, method in methods_of(primary.measure, primary.test, data.plan.seed).items():
        if trials > method.most_trials:
            left_out[key] = f"takes too long above {method.most_trials:,} trials"
        elif participants > method.most_participants:
            left_out[key] = f"takes too long above {method.most_participants:,} participants"
        else:
            results[key] = method.run(given)
    treatment, reference = (
        mean(given.y[arm], given.unit) for arm in (given.treated, ~given.treated)
    )
    return Comparison(
        primary.measure,
        given.unit,
        (treatment, reference),
        primary.test,
        results,
        left_out,
        superiority(given) if primary.measure == "correct" else None,
    )


def primary_test(primary: Primary, given: Outcome) -> TestResult:
    """Run the plan's test of a hypothesis; EmptyArmError if an arm has no value."""
    return _TWO_WAY[primary.test].run(given)


def methods_of(measure: str, primary: str, seed: int) -> dict[str, Method]:
    """Return the methods for a measure by their keys, the primary test first.

    `seed` is that of permutations drawn at random.
    """
    permutation = {
        "cluster_permutation": Method(
            "Participants permuted between the arms",
            lambda given: cluster_permutation(given, np.random.default_rng(seed)),
        )
    }
    first = {primary: _TWO_WAY[primary]}
    if measure == "correct":
        return {**first, **_OF_CORRECT, **permutation, **_OF_TABLE}
    models = _OF_CONFIDENCE if measure == "confidence" else {}
    return {**first, **_TWO_WAY, **models, **_OF_RANKS, **permutation, **_ON_TRIALS}


def _of_table(test: Callable[[TwoByTwo], TestResult]) -> Callable[[Outcome], TestResult]:
    """Let a test of a 2x2 table take trials."""

    def run(given: Outcome) -> TestResult:
        data = given.present()
        counts = np.bincount(2 * (~data.treated) + (data.y == 0), minlength=4)
        missing = np.isnan(given.y)
        lacking = [(missing & given.treated).sum(), (missing & ~given.treated).sum()]
        return test(TwoByTwo(*map(int, (*counts, *lacking))))

    return run


def _of_trials(test: Callable[..., TestResult]) -> Callable[[Outcome], TestResult]:
    """Let a test of two samples take the trials of both arms."""
    return lambda given: test(given.y[given.treated], given.y[~given.treated], given.name)


def _shift(given: Outcome) -> TestResult:
    """Hodges-Lehmann shift of the trials."""
    return hodges_lehmann(given.y[given.treated], given.y[~given.treated], given.name, given.unit)


def _of_participants(given: Outcome) -> TestResult:
    """Mann-Whitney test of the participants' means."""
    people = by_participant(given)
    means, treated = people.means, people.treated
    test = mann_whitney_exact_if_few(means[treated], means[~treated], given.name, of="participants")
    return replace(test, n_missing=people.n_missing)


_TWO_WAY = {
    "two_way_difference": Method(
        "Difference, clustered by participant and scenario", two_way_difference
    ),
    "two_way_auc": Method("AUC, clustered by participant and scenario", two_way_auc),
}
_PARTICIPANTS = {
    "mann_whitney_participants": Method("Mann-Whitney on participants' means", _of_participants)
}
_OF_CORRECT = {
    "crossed_logistic": Method(
        "Crossed logistic mixed model", crossed_logistic, most_trials=MOST_TRIALS_OF_MODELS
    ),
    "participant_logistic": Method(
        "Logistic mixed model, participants only",
        participant_logistic,
        most_trials=MOST_TRIALS_OF_MODELS,
    ),
    "clustered_difference": Method("Difference, clustered by participant", clustered_difference),
    "gee_logistic": Method(
        "Logistic regression by GEE, clustered by participant",
        gee_logistic,
        most_participants=MOST_PARTICIPANTS_OF_GEE,
    ),
    "rao_scott": Method("Rao-Scott chi-square, clustered by participant", rao_scott),
    **_PARTICIPANTS,
}
_OF_CONFIDENCE = {
    "crossed_ordinal": Method(
        "Crossed ordinal mixed model", crossed_ordinal, most_trials=MOST_TRIALS_OF_MODELS
    ),
}
_OF_RANKS = {
    "clustered_auc": Method("AUC, clustered by participant", clustered_auc),
    "clustered_difference": Method("Difference, clustered by participant", clustered_difference),
    **_PARTICIPANTS,
}
_OF_TABLE = {
    "risk_difference": Method("Difference, Newcombe's interval", _of_table(risk_difference)),
    "odds_ratio": Method("Odds ratio, Woolf's interval", _of_table(odds_ratio)),
    "chi_square": Method("Chi-square, as in the paper", _of_table(chi_square)),
    "chi_square_yates": Method(
        "Chi-square, Yates's correction", _of_table(partial(chi_square, yates=True))
    ),
    "g_test": Method("G test", _of_table(g_test)),
    "fisher_exact": Method("Fisher's exact test", _of_table(fisher_exact)),
}
_ON_TRIALS = {
    "mann_whitney": Method("Mann-Whitney, as in the paper", _of_trials(mann_whitney)),
    "brunner_munzel": Method("Brunner-Munzel", _of_trials(brunner_munzel)),
    "hodges_lehmann": Method("Hodges-Lehmann shift", _shift),
}
INDEPENDENT = frozenset((*_OF_TABLE, *_ON_TRIALS))
"""Methods that treat trials as independent."""
