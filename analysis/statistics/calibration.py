"""What confidence and time tell about the guess: accuracy along either, and discrimination."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .codes import CONSTANT_OUTCOME, FEW_CLUSTERS, ONE_PARTICIPANT
from .estimates import LEVEL
from .inference import FEW, student, undefined
from .influence import cluster_count, cluster_variance, of_auc, of_mean
from .outcome import Numbers, Outcome
from .result import TestResult

TIME_BINS = 10
"""Bins of stop time, each with about as many trials."""


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """Share of correct guesses among trials of one arm whose value is in `lower` to `upper`.

    `mean` of these values and `share`, `low`, `high` (95 %) are None without a trial, the
    interval also with one participant.
    """

    lower: float
    upper: float
    mean: float | None
    n: int
    n_correct: int
    n_participants: int
    share: float | None
    low: float | None
    high: float | None


@dataclass(frozen=True, kw_only=True)
class AccuracyBy:
    """Accuracy of both arms in the same bins of a value measured in `unit`."""

    unit: str
    treatment: tuple[Accuracy, ...]
    reference: tuple[Accuracy, ...]
    n: int
    n_missing: int
    method: str = (
        "share of correct guesses; Wilson interval, 95 %, at the effective number of trials "
        "(trials clustered by participant), t on participants - 1 df"
    )
    source: str = (
        "Korn and Graubard (1998), Survey Methodology 24, 193-201; "
        "Dean and Pagano (2015), Journal of Survey Statistics and Methodology 3, 484-503"
    )


@dataclass(frozen=True, kw_only=True)
class Discrimination(TestResult):
    """Probability that a right guess of one arm was given with more confidence than a wrong one.

    Ties count half. `gamma` leaves them out (Goodman and Kruskal); None where all are tied.
    """

    gamma: float | None
    n_correct: int
    n_wrong: int
    n_participants: int


def accuracy_by_confidence(correct: Outcome, confidence: Numbers, levels: range) -> AccuracyBy:
    """Return the share of correct guesses at each level of confidence, for both arms.

    `correct` holds 1 or 0, `confidence`, shape (N,), the ratings of the same trials, each in
    `levels`; trials without one of the two are left out. EmptyArmError if an arm has none left.
    """
    edges = np.array(levels, dtype=np.float64)
    return _accuracy_by(correct, confidence, edges, edges, "scale points")


def accuracy_by_time(correct: Outcome, stop_time_s: Numbers) -> AccuracyBy:
    """Return the share of correct guesses in tenths of all stop times, for both arms.

    `correct` holds 1 or 0, `stop_time_s`, shape (N,), s, is of the same trials; trials without one
    of the two are left out. Both arms share the bins, each without its lower edge but for the
    first; where times are tied there are fewer than `TIME_BINS`. EmptyArmError if an arm is empty.
    """
    _, times = _together(correct, stop_time_s)
    edges = np.unique(
        np.quantile(times, np.arange(TIME_BINS + 1) / TIME_BINS, method="inverted_cdf")
    )
    lower = edges[:-1] if len(edges) > 1 else edges
    return _accuracy_by(correct, stop_time_s, lower, edges[-len(lower) :], "s")


def discrimination(correct: Outcome, confidence: Numbers) -> tuple[Discrimination, Discrimination]:
    """Test within the treatment and the reference arm whether confidence tells right from wrong.

    `correct` holds 1 or 0, `confidence`, shape (N,), is of the same trials; trials without one of
    the two are left out. The AUC of right against wrong guesses, its influence values summed over
    participants, most of whom have both; t on participants - 1 df. Where all guesses are right,
    or all wrong, nothing is estimated. EmptyArmError if an arm is empty.
    """
    data, ratings = _together(correct, confidence)
    treatment, reference = (
        _discrimination(
            Outcome(
                correct.name,
                "scale points",
                y=ratings[of_arm],
                treated=data.y[of_arm] == 1,
                participant=data.participant[of_arm],
                scenario=data.scenario[of_arm],
            ),
            n_missing=int(all_of_arm.sum() - of_arm.sum()),
        )
        for of_arm, all_of_arm in (
            (data.treated, correct.treated),
            (~data.treated, ~correct.treated),
        )
    )
    return treatment, reference


def _together(correct: Outcome, values: Numbers) -> tuple[Outcome, Numbers]:
    """Return the trials that have a guess and a value, and their values."""
    y = np.where(np.isnan(values), np.nan, correct.y)
    return dataclasses.replace(correct, y=y).present(), values[~np.isnan(y)]


def _accuracy_by(
    correct: Outcome, values: Numbers, lower: Numbers, upper: Numbers, unit: str
) -> AccuracyBy:
    """Return accuracy in bins that end at `upper`, ends included; every value lies in one."""
    data, values = _together(correct, values)
    number = np.searchsorted(upper, values, side="left")
    treatment, reference = (
        tuple(
            _accuracy(data, values, of_arm & (number == bin_), float(start), float(end))
            for bin_, (start, end) in enumerate(zip(lower, upper, strict=True))
        )
        for of_arm in (data.treated, ~data.treated)
    )
    return AccuracyBy(
        unit=unit,
        treatment=treatment,
        reference=reference,
        n=len(data.y),
        n_missing=len(correct.y) - len(data.y),
    )


def _accuracy(
    data: Outcome, values: Numbers, here: NDArray[np.bool_], lower: float, upper: float
) -> Accuracy:
    """Return the accuracy of the trials `here`."""
    y, participant = data.y[here], data.participant[here]
    n_participants = cluster_count(participant)
    mean = share = low = high = None
    if len(y):
        influence = of_mean(y)
        mean, share = float(values[here].mean()), influence.estimate
        variance = cluster_variance(influence.h, participant)
        if variance is not None:
            low, high = _wilson(share, variance, len(y), n_participants)
    return Accuracy(
        lower=lower,
        upper=upper,
        mean=mean,
        n=len(y),
        n_correct=int(y.sum()),
        n_participants=n_participants,
        share=share,
        low=low,
        high=high,
    )


def _wilson(share: float, variance: float, n: int, n_participants: int) -> tuple[float, float]:
    """Return Wilson's interval at the number of independent trials that would be as uncertain.

    That is at most `n`. Where participants do not differ, as when all guesses are right, their
    variance tells nothing, and each of them counts as one trial.
    """
    from scipy.special import stdtrit

    spread = share * (1 - share)
    n_effective = min(n, spread / variance) if variance else n_participants
    c2 = float(stdtrit(n_participants - 1, (1 + LEVEL) / 2)) ** 2 / n_effective
    middle = (share + c2 / 2) / (1 + c2)
    half = math.sqrt(c2 * (spread + c2 / 4)) / (1 + c2)
    return max(0.0, middle - half), min(1.0, middle + half)


def _discrimination(data: Outcome, n_missing: int) -> Discrimination:
    """Compare the ratings `data.y` of right (`data.treated`) with those of wrong guesses."""
    n_correct = int(data.treated.sum())
    n_wrong = len(data.y) - n_correct
    n_participants = cluster_count(data.participant)
    gamma = None
    found = undefined(None, 0.5, CONSTANT_OUTCOME)
    if n_correct and n_wrong:
        influence = of_auc(data)
        gamma = _gamma(data, influence.estimate)
        variance = cluster_variance(influence.h, data.participant)
        if variance is None:
            found = undefined(influence.estimate, 0.5, ONE_PARTICIPANT)
        else:
            few = (FEW_CLUSTERS,) if n_participants < FEW else ()
            found = student(influence.estimate, 0.5, variance, n_participants - 1, *few)
    return Discrimination(
        **found,
        unit="probability",
        n=len(data.y),
        n_missing=n_missing,
        method="AUC of confidence, right against wrong guesses, clustered by participant, "
        "t on participants - 1 df",
        source="Obuchowski (1997), Biometrics 53, 567-578",
        gamma=gamma,
        n_correct=n_correct,
        n_wrong=n_wrong,
        n_participants=n_participants,
    )


def _gamma(data: Outcome, auc: float) -> float | None:
    """Return Goodman and Kruskal's gamma: the AUC's surplus over the share of pairs not tied."""
    ratings, level = np.unique(data.y, return_inverse=True)
    right, wrong = (
        np.bincount(level[of_guess], minlength=len(ratings)) / of_guess.sum()
        for of_guess in (data.treated, ~data.treated)
    )
    untied = 1 - float(right @ wrong)
    return (2 * auc - 1) / untied if len(ratings) > 1 else None
