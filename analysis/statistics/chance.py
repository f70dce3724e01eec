"""Correct guesses of each arm against guessing at random."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .degrees_of_freedom import TWO_WAY_DF
from .influence import of_mean
from .outcome import Outcome
from .two_way import SOURCE, TwoWay, two_way


def against_chance(outcome: Outcome, chance: float) -> tuple[TwoWay, TwoWay]:
    """Test the treatment's and the reference arm's share of correct guesses against `chance`.

    `y` is 0 or 1. Trials are clustered by participant and by scenario; t on the smaller of
    participants - 1 and scenarios - 1 degrees of freedom. EmptyArmError if an arm has no value.
    """
    data = outcome.present()
    return _of_arm(outcome, data, True, chance), _of_arm(outcome, data, False, chance)


def _of_arm(outcome: Outcome, data: Outcome, treated: bool, chance: float) -> TwoWay:
    arm = data.treated == treated
    trials = replace(
        data,
        y=data.y[arm],
        treated=data.treated[arm],
        participant=data.participant[arm],
        scenario=data.scenario[arm],
    )
    return TwoWay(
        **two_way(trials, of_mean(trials.y), chance),
        unit=outcome.unit,
        n=len(trials.y),
        n_missing=int(np.isnan(outcome.y[outcome.treated == treated]).sum()),
        method=f"share against chance, trials clustered by participant and scenario, {TWO_WAY_DF}",
        source=SOURCE,
    )
