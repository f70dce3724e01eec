"""Trials simulated from participants crossed with scenarios, on the logit scale.

A trial of participant p on scenario s in arm c has the latent value

    shift * [c is the treatment] + u_p + v_s + w_sc + logistic noise,

with normal u, v, w, and its answer is how many thresholds that value exceeds. With one threshold
this is the crossed logistic model of correct guesses, with six a cumulative logit model of
confidence from 1 to 7. Thresholds and shift are solved so that what the model says of all people
and scenarios together (shares, AUC) holds, not what it says of the average one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .errors import AnalysisError
from .statistics.outcome import Outcome

CONFIDENCE_COUNTS = (15, 16, 18, 49, 68, 108, 246)
"""Answers 1 to 7 of the reference arm in a synthetic data set that reproduces the paper's numbers.

The paper prints mean 5.78 and U = 231203 for confidence; its data are not published.
"""
CONFIDENCE_AUC = 0.546
"""Chance that a trial of the treatment arm has the higher confidence, ties half: the paper's U."""

_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(81)
_LARGEST_SD = 5.0
"""Up to it 81 nodes integrate a share to five digits."""
_FARTHEST = 50.0


@dataclass(frozen=True)
class Spread:
    """Standard deviations on the logit scale: participants, scenarios, scenario x condition."""

    participant: float
    scenario: float
    scenario_condition: float

    def __post_init__(self) -> None:
        for sd in (self.participant, self.scenario, self.scenario_condition):
            if not 0 <= sd <= _LARGEST_SD:
                raise AnalysisError(
                    f"standard deviation: expected 0 to {_LARGEST_SD:g} on the logit scale, "
                    f"got {sd:g}"
                )

    @property
    def total(self) -> float:
        """Standard deviation of all three together."""
        return float(np.linalg.norm([self.participant, self.scenario, self.scenario_condition]))


@dataclass(frozen=True)
class Design:
    """Size of a study: participants of the treatment and the reference arm, trials of each.

    Where there are more trials than `scenarios`, everybody sees all of them before one again.
    """

    treatment: int
    reference: int
    trials_each: int = 10
    scenarios: int = 37

    def __post_init__(self) -> None:
        for what, size in (
            ("participants in an arm", min(self.treatment, self.reference)),
            ("trials per participant", self.trials_each),
            ("scenarios", self.scenarios),
        ):
            if size < 1:
                raise AnalysisError(f"{what}: expected at least 1, got {size}")

    @property
    def participants(self) -> int:
        """Of both arms together."""
        return self.treatment + self.reference


def halves(participants: int, trials_each: int = 10, scenarios: int = 37) -> Design:
    """Return the design with half of the participants in each arm; AnalysisError if odd."""
    if participants < 2 or participants % 2:
        raise AnalysisError(f"participants: expected an even number from 2, got {participants}")
    return Design(participants // 2, participants // 2, trials_each, scenarios)


@dataclass(frozen=True, eq=False)
class Dealt:
    """The N trials of a study, arrays of shape (N,); `effect`: what their clusters add to each."""

    treated: NDArray[np.bool_]
    participant: NDArray[np.int64]
    scenario: NDArray[np.int64]
    effect: NDArray[np.float64]


@dataclass(frozen=True)
class CrossedModel:
    """What answers come from: rising `thresholds`, and the treatment's `shift`, in logits.

    An answer is `lowest` plus the number of thresholds exceeded; `unit` is that of answers.
    """

    measure: str
    unit: str
    lowest: int
    thresholds: tuple[float, ...]
    shift: float
    spread: Spread


def correct_model(spread: Spread, treatment: float, reference: float) -> CrossedModel:
    """Model of correct guesses with these shares in the arms; AnalysisError unless .001-.999."""
    for share in (treatment, reference):
        if not 0.001 <= share <= 0.999:
            raise AnalysisError(f"share correct: expected .001 to .999, got {share:g}")
    lower, higher = (_threshold(share, spread.total) for share in (treatment, reference))
    return CrossedModel("correct", "share", 0, (higher,), higher - lower, spread)


def confidence_model(spread: Spread, auc: float = CONFIDENCE_AUC) -> CrossedModel:
    """Model of confidence, 1 to 7: the reference arm answers as `CONFIDENCE_COUNTS`.

    `auc` is the effect, as `CONFIDENCE_AUC` explains it; AnalysisError unless .05-.75 (more is not
    possible while half of the reference arm answers 7).
    """
    from scipy import optimize

    if not 0.05 <= auc <= 0.75:
        raise AnalysisError(f"AUC: expected .05 to .75, got {auc:g}")
    above = 1 - np.cumsum(CONFIDENCE_COUNTS)[:-1] / sum(CONFIDENCE_COUNTS)
    thresholds = np.array([_threshold(share, spread.total) for share in above])
    reference = _shares(thresholds, spread.total)

    def surplus(shift: float) -> float:
        return _auc(_shares(thresholds - shift, spread.total), reference) - auc

    shift = optimize.brentq(surplus, -_FARTHEST, _FARTHEST)
    return CrossedModel("confidence", "points", 1, tuple(thresholds.tolist()), shift, spread)


def simulate(model: CrossedModel, design: Design, rng: np.random.Generator) -> Outcome:
    """Draw all trials of one study, participants of the treatment arm first."""
    trials = deal(design, model.spread, rng)
    latent = model.shift * trials.treated + trials.effect + rng.logistic(size=len(trials.effect))
    exceeded = np.searchsorted(model.thresholds, latent)
    return Outcome(
        model.measure,
        model.unit,
        (model.lowest + exceeded).astype(np.float64),
        trials.treated,
        trials.participant,
        trials.scenario,
    )


def deal(design: Design, spread: Spread, rng: np.random.Generator) -> Dealt:
    """Deal scenarios to participants, and draw what both, and scenarios in arms, add."""
    participant = np.repeat(np.arange(design.participants), design.trials_each)
    treated = participant < design.treatment
    arms = (design.treatment, design.reference)
    scenario = np.concatenate([_dealt(design, size, rng) for size in arms]).ravel()
    effect = (
        rng.normal(0, spread.participant, design.participants)[participant]
        + rng.normal(0, spread.scenario, design.scenarios)[scenario]
        + rng.normal(0, spread.scenario_condition, (2, design.scenarios))[
            treated.astype(np.int64), scenario
        ]
    )
    return Dealt(treated, participant, scenario, effect)


def _dealt(design: Design, participants: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """Deal an arm's scenarios, (participants, trials): none is ever ahead by more than one.

    Everybody gets those used least so far, ties broken at random, as in the study; after all of
    them once where trials are enough, twice, and so on, in an order that no answer depends on.
    """
    rounds, more = divmod(design.trials_each, design.scenarios)
    uses = np.zeros(design.scenarios)
    last = np.empty((participants, more), dtype=np.int64)
    for own, lot in zip(last, rng.random((participants, design.scenarios)), strict=True):
        own[:] = np.argsort(uses + lot)[:more]
        uses[own] += 1
    whole = np.tile(np.arange(design.scenarios), (participants, rounds))
    return np.concatenate([whole, last], axis=1)


def _share_above(threshold: NDArray[np.float64] | float, sd: float) -> NDArray[np.float64]:
    """Chance that normal plus logistic noise exceeds each threshold, by Gauss-Hermite."""
    from scipy.special import expit

    distance = sd * _NODES - np.asarray(threshold)[..., None]
    share: NDArray[np.float64] = expit(distance) @ (_WEIGHTS / _WEIGHTS.sum())
    return share


def _threshold(share_above: float, sd: float) -> float:
    """Threshold that normal plus logistic noise exceeds with the given chance."""
    from scipy import optimize

    root: float = optimize.brentq(
        lambda threshold: float(_share_above(threshold, sd)) - share_above, -_FARTHEST, _FARTHEST
    )
    return root


def _shares(thresholds: NDArray[np.float64], sd: float) -> NDArray[np.float64]:
    """Chance of each answer, lowest first."""
    return -np.diff(_share_above(thresholds, sd), prepend=1.0, append=0.0)


def _auc(treatment: NDArray[np.float64], reference: NDArray[np.float64]) -> float:
    """Chance that an answer of the treatment arm is the higher, ties half."""
    below = np.cumsum(reference) - reference / 2
    return float(treatment @ below)
