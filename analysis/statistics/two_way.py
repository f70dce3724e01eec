"""The variance of an estimate when trials are clustered by participant and by scenario."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .codes import FEW_CLUSTERS, NO_SCENARIO_KNOWN, ONE_PARTICIPANT, ONE_SCENARIO
from .degrees_of_freedom import by_participant_and_scenario, participants_of_arms
from .inference import FEW, Inference, student, undefined
from .influence import ROUNDING, Influence, cluster_count, cluster_variance
from .outcome import UNKNOWN, Outcome
from .result import TestResult

SOURCE = "Cameron, Gelbach and Miller (2011), Journal of Business & Economic Statistics 29, 238-249"


@dataclass(frozen=True, kw_only=True)
class TwoWay(TestResult):
    """An estimate with its variance by participants, by scenarios and by trials alone.

    `se`^2 = max(v_participant + v_scenario - v_trial, v_participant); each is in `unit`^2, and
    None where there is a single cluster. `v_scenario` and `v_trial` are of the trials whose
    scenario is known: a trial with a scenario of its own would add the same to both. Where none is
    known, `se`^2 = v_participant.
    """

    v_participant: float | None
    v_scenario: float | None
    v_trial: float | None
    participants: int
    scenarios: int


class TwoWayInference(Inference):
    """The fields of a TwoWay that follow from influence values."""

    v_participant: float | None
    v_scenario: float | None
    v_trial: float | None
    participants: int
    scenarios: int


def two_way(data: Outcome, influence: Influence, null: float, *warnings: str) -> TwoWayInference:
    """Test an estimate against `null` by t, degrees of freedom as in degrees_of_freedom.py.

    `data` has no missing values and may be of one arm; trials of scenario `UNKNOWN` count as of
    one of their own each, but not among the scenarios. If no scenario is known, participants alone
    are clusters, with a warning. Undefined, with a warning, if an arm has a single participant
    (whose trials cannot tell how participants differ) or all known scenarios are one. Source:
    Cameron, Gelbach and Miller (2011).
    """
    known = data.scenario != UNKNOWN
    h, scenario = influence.h[known], data.scenario[known]
    v_participant = cluster_variance(influence.h, data.participant)
    v_scenario = cluster_variance(h, scenario)
    v_trial = cluster_variance(h, np.arange(len(h)))
    participants, scenarios = cluster_count(data.participant), cluster_count(scenario)
    fewest = min(participants_of_arms(data))
    if v_participant is None or fewest == 1:
        inference = undefined(influence.estimate, null, *warnings, ONE_PARTICIPANT)
    elif scenarios == 1:
        inference = undefined(influence.estimate, null, *warnings, ONE_SCENARIO)
    else:
        if scenarios == 0:
            warnings = (*warnings, NO_SCENARIO_KNOWN)
        if min(fewest, scenarios or fewest) < FEW:
            warnings = (*warnings, FEW_CLUSTERS)
        beyond_participants = (v_scenario or 0.0) - (v_trial or 0.0)
        variance = v_participant + max(beyond_participants, 0.0)
        if variance < ROUNDING * (v_scenario or 0.0):
            variance = 0.0
        df = by_participant_and_scenario(data, influence.h)
        inference = student(influence.estimate, null, variance, df, *warnings)
    return TwoWayInference(
        **inference,
        v_participant=v_participant,
        v_scenario=v_scenario,
        v_trial=v_trial,
        participants=participants,
        scenarios=scenarios,
    )
