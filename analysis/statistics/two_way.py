"""The variance of an estimate when trials are clustered by participant and by scenario."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .codes import FEW_CLUSTERS, ONE_PARTICIPANT, ONE_SCENARIO
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
    scenario is known: a trial with a scenario of its own would add the same to both.
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
    """Test an estimate against `null` by t on scenarios - 1 degrees of freedom.

    `data` has no missing values and may be of one arm; trials of scenario `UNKNOWN` count as of
    one of their own each, but not among the scenarios. Undefined, with a warning, if an arm has a
    single participant (whose trials cannot tell how participants differ) or all trials are of one
    scenario. Source: Cameron, Gelbach and Miller (2011).
    """
    known = data.scenario != UNKNOWN
    h, scenario = influence.h[known], data.scenario[known]
    v_participant = cluster_variance(influence.h, data.participant)
    v_scenario = cluster_variance(h, scenario)
    v_trial = cluster_variance(h, np.arange(len(h)))
    participants, scenarios = cluster_count(data.participant), cluster_count(scenario)
    arms = (data.treated, ~data.treated)
    fewest = min(cluster_count(data.participant[arm]) for arm in arms if arm.any())
    if v_participant is None or fewest == 1:
        inference = undefined(influence.estimate, null, *warnings, ONE_PARTICIPANT)
    elif v_scenario is None or v_trial is None:
        inference = undefined(influence.estimate, null, *warnings, ONE_SCENARIO)
    else:
        if min(fewest, scenarios) < FEW:
            warnings = (*warnings, FEW_CLUSTERS)
        variance = max(v_participant + v_scenario - v_trial, v_participant)
        if variance < ROUNDING * v_scenario:
            variance = 0.0
        inference = student(influence.estimate, null, variance, scenarios - 1, *warnings)
    return TwoWayInference(
        **inference,
        v_participant=v_participant,
        v_scenario=v_scenario,
        v_trial=v_trial,
        participants=participants,
        scenarios=scenarios,
    )
