"""Ratings by a cumulative logit mixed model with crossed participants and scenarios.

Own code: interlace-lme, the one package that fits it, stops short of the maximum (log-likelihood
-1947.189 against -1947.113 of R's ordinal on the golden case).
"""

from __future__ import annotations

from .crossed_test import CrossedResult, crossed_test
from .outcome import Outcome


def crossed_ordinal(outcome: Outcome, interaction: bool = True) -> CrossedResult:
    """Test the arm in rating ~ arm + (1 | participant) + (1 | scenario) + (1 | scenario in arm).

    `outcome.y` may be any ordered values; those that occur are the categories, and only their order
    counts, by a cumulative logit. Without `interaction` the last term is left out, and the test
    rejects too often where scenarios differ between the arms. Maximum likelihood by Laplace's
    approximation, as R's ordinal::clmm; t on the degrees of freedom of the two-way AUC, where
    clmm tests by z. What cannot be estimated: see crossed_test. Source: Agresti (2010), Analysis of
    Ordinal Categorical Data, chapter 10; Christensen (2019), ordinal; for the last term Baayen,
    Davidson and Bates (2008), Journal of Memory and Language 59, 390-412.
    """
    result, _ = crossed_test(
        outcome,
        interaction=interaction,
        method="Crossed ordinal mixed model",
        source="Agresti (2010); without scenarios within arms agrees with R ordinal::clmm",
    )
    return result
