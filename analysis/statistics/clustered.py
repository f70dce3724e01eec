"""Two arms compared when trials of one participant, and of one scenario, resemble each other.

One-way tests take participants as clusters, two-way tests participants and scenarios. All rest on
the influence values of influence.py, so none assumes how trials within a cluster are related.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .codes import (
    FEW_CLUSTERS,
    NO_OVERLAP,
    NO_SCENARIO_SHARED,
    NO_VARIATION,
    ONE_PARTICIPANT,
    SCENARIOS_NOT_SHARED,
)
from .degrees_of_freedom import ONE_WAY_DF, TWO_WAY_DF, by_participant, within_participants
from .inference import FEW, Inference, student, undefined
from .influence import Influence, cluster_count, cluster_variance, of_auc, of_difference
from .outcome import UNKNOWN, Outcome
from .result import TestResult
from .two_way import SOURCE as CAMERON
from .two_way import TwoWay, two_way

OBUCHOWSKI = "Obuchowski (1997), Biometrics 53, 567-578"


@dataclass(frozen=True, kw_only=True)
class ClusteredDifference(TestResult):
    """Difference of means; how the trials of each arm are clustered.

    `design_effect_*`: variance of the arm's mean over what it were with independent trials, None
    where undefined.
    """

    mean_treatment: float
    mean_reference: float
    design_effect_treatment: float | None
    design_effect_reference: float | None
    participants_treatment: int
    participants_reference: int


@dataclass(frozen=True, kw_only=True)
class ClusteredAuc(TestResult):
    """AUC, the probability of a larger value in the treatment arm; `rank_biserial` = 2 AUC - 1."""

    rank_biserial: float
    participants_treatment: int
    participants_reference: int


@dataclass(frozen=True, kw_only=True)
class TwoWayAuc(TwoWay):
    """AUC, the probability of a larger value in the treatment arm; `rank_biserial` = 2 AUC - 1."""

    rank_biserial: float


@dataclass(frozen=True)
class _Arm:
    """What an arm adds to the variance of an estimate; None with a single participant."""

    variance: float | None
    unclustered: float
    participants: int

    @property
    def design_effect(self) -> float | None:
        """Variance over what it were if trials were independent; None where undefined."""
        if self.variance is None or not self.unclustered:
            return None
        return self.variance / self.unclustered


def clustered_difference(outcome: Outcome) -> ClusteredDifference:
    """Compare means, trials clustered by participant.

    Linearised variance of a ratio per arm times K/(K-1), Welch's degrees of freedom; with
    participants in both arms that of their summed influence, on participants - 1.
    EmptyArmError if an arm has no value. Source: Cochran (1977), Sampling Techniques.
    """
    data = outcome.present()
    influence = of_difference(data)
    treatment, reference = _arms(data, influence)
    return ClusteredDifference(
        **_one_way(data, influence, 0.0, treatment, reference),
        unit=outcome.unit,
        n=len(data.y),
        n_missing=outcome.n_missing,
        method=f"difference of means, trials clustered by participant, {ONE_WAY_DF}",
        source="Cochran (1977), Sampling Techniques, ratio estimates; as R's survey::svymean",
        mean_treatment=float(data.y[data.treated].mean()),
        mean_reference=float(data.y[~data.treated].mean()),
        design_effect_treatment=treatment.design_effect,
        design_effect_reference=reference.design_effect,
        participants_treatment=treatment.participants,
        participants_reference=reference.participants,
    )


def clustered_auc(outcome: Outcome) -> ClusteredAuc:
    """Compare which arm's values tend to be larger, trials clustered by participant.

    Variance of the placements per arm times K/(K-1), Welch's degrees of freedom; with participants
    in both arms that of their summed influence, on participants - 1.
    EmptyArmError if an arm has no value. Source: Obuchowski (1997).
    """
    data = outcome.present()
    influence = of_auc(data)
    treatment, reference = _arms(data, influence)
    inference = _one_way(data, influence, 0.5, treatment, reference)
    inference["warnings"] = _told_apart(influence.estimate, inference["warnings"])
    return ClusteredAuc(
        **inference,
        unit="probability",
        n=len(data.y),
        n_missing=outcome.n_missing,
        method=f"AUC, trials clustered by participant, {ONE_WAY_DF}",
        source=OBUCHOWSKI,
        rank_biserial=2 * influence.estimate - 1,
        participants_treatment=treatment.participants,
        participants_reference=reference.participants,
    )


def two_way_difference(outcome: Outcome) -> TwoWay:
    """Compare means, trials clustered by participant and by scenario.

    Participants may be in one arm or in both; t on the degrees of freedom of degrees_of_freedom.py.
    EmptyArmError if an arm has no value. Source: Cameron, Gelbach and Miller (2011).
    """
    data = outcome.present()
    return TwoWay(
        **two_way(data, of_difference(data), 0.0, *_sharing(data)),
        unit=outcome.unit,
        n=len(data.y),
        n_missing=outcome.n_missing,
        method=f"difference of means, trials clustered by participant and scenario, {TWO_WAY_DF}",
        source=CAMERON,
    )


def two_way_auc(outcome: Outcome) -> TwoWayAuc:
    """Compare which arm's values tend to be larger, clustered by participant and by scenario.

    Participants may be in one arm or in both; t on the degrees of freedom of degrees_of_freedom.py.
    EmptyArmError if an arm has no value. Source: Obuchowski (1997) for the placements; Cameron,
    Gelbach and Miller (2011) for two ways.
    """
    data = outcome.present()
    influence = of_auc(data)
    inference = two_way(data, influence, 0.5, *_sharing(data))
    inference["warnings"] = _told_apart(influence.estimate, inference["warnings"])
    return TwoWayAuc(
        **inference,
        unit="probability",
        n=len(data.y),
        n_missing=outcome.n_missing,
        method=f"AUC, trials clustered by participant and scenario, {TWO_WAY_DF}",
        source=f"{OBUCHOWSKI}; {CAMERON}",
        rank_biserial=2 * influence.estimate - 1,
    )


def _arms(data: Outcome, influence: Influence) -> tuple[_Arm, _Arm]:
    """Return what the treatment and the reference arm add to the estimate's variance."""
    return _arm(data, influence, data.treated), _arm(data, influence, ~data.treated)


def _arm(data: Outcome, influence: Influence, arm: NDArray[np.bool_]) -> _Arm:
    h, participant = influence.h[arm], data.participant[arm]
    return _Arm(cluster_variance(h, participant), float(h @ h), cluster_count(participant))


def _one_way(
    data: Outcome, influence: Influence, null: float, treatment: _Arm, reference: _Arm
) -> Inference:
    """Test by t; arms of the same participants vary together, others each by itself."""
    if treatment.variance is None or reference.variance is None:
        return undefined(influence.estimate, null, ONE_PARTICIPANT)
    variance = treatment.variance + reference.variance
    if within_participants(data):
        variance = cluster_variance(influence.h, data.participant) or 0.0
    fewer = min(treatment.participants, reference.participants)
    few = (FEW_CLUSTERS,) if fewer < FEW else ()
    df = by_participant(data, influence.h)
    return student(influence.estimate, null, variance, df, *few)


def _told_apart(auc: float, warnings: tuple[str, ...]) -> tuple[str, ...]:
    """Say of arms without overlap, where all placements are equal, that this is why none varies."""
    if auc not in (0.0, 1.0):
        return warnings
    return tuple(NO_OVERLAP if code == NO_VARIATION else code for code in warnings)


def _sharing(data: Outcome) -> tuple[str, ...]:
    """Warn if a scenario was seen in one arm only, where it cannot be told from the condition."""
    known = data.scenario != UNKNOWN
    scenario, treated = data.scenario[known], data.treated[known]
    seen, in_treatment = np.bincount(scenario), np.bincount(scenario, treated)
    shared = (in_treatment > 0) & (in_treatment < seen)
    if shared.all():
        return ()
    return (SCENARIOS_NOT_SHARED if shared.any() else NO_SCENARIO_SHARED,)
