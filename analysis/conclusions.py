"""What the plan's primary tests answer, with Holm's correction and the model beside them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from .methods import MODELS, Comparison
from .plan import Plan
from .statistics.codes import CONSTANT_OUTCOME
from .statistics.equivalence import Equivalence, two_one_sided
from .statistics.family import holm
from .statistics.result import TestResult

Direction = Literal["more", "less", "none", "undefined"]

EXPECTED: Mapping[str, Direction] = {
    "correct": "more",
    "prediction_time_s": "less",
    "stop_time_s": "less",
    "confidence": "more",
}
"""What the hypotheses say of the treatment: more guesses correct, sooner, with more confidence."""

SMALLEST_EFFECT_KEYS = {
    "share": "share",
    "probability": "auc",
    "s": "s",
    "scale points": "scale_points",
}
"""The plan's key of the smallest effect of interest, by the unit of a primary test."""


@dataclass(frozen=True)
class Conclusion:
    """What one measure says of its hypothesis.

    `direction` is what was shown of the treatment arm at the plan's alpha, and is concluded from
    `primary` alone, by `p_holm` where the measure is of the family (None elsewhere). `model` is the
    mixed model beside it, None where there is none; `model_p_holm` and `model_direction` are what
    its p would make of the same family in the place of the primary test's, "undefined" without one.
    Where no difference is shown, `equivalence` tells what can be excluded, None where the plan
    names no smallest effect of interest in the unit of the test.
    """

    hypothesis: str
    measure: str
    primary: TestResult
    p_holm: float | None
    direction: Direction
    supported: bool
    model: TestResult | None
    model_p_holm: float | None
    model_direction: Direction
    equivalence: Equivalence | None

    @property
    def models_agree(self) -> bool | None:
        """Whether primary test and model show the same; None where either is not defined."""
        if "undefined" in (self.direction, self.model_direction):
            return None
        return self.direction == self.model_direction


def conclude(plan: Plan, comparisons: Mapping[str, Comparison]) -> tuple[Conclusion, ...]:
    """Answer each hypothesis of the plan, in its order."""
    family = {measure: _tested_p(comparisons[measure].primary) for measure in plan.holm_family}
    return tuple(
        _conclusion(plan, each.hypothesis, comparisons[each.measure], family)
        for each in plan.primary
    )


def _conclusion(
    plan: Plan, hypothesis: str, compared: Comparison, family: Mapping[str, float | None]
) -> Conclusion:
    alpha = plan.alpha
    primary = compared.primary
    model = next(filter(None, (compared.results.get(key) for key in MODELS)), None)
    p_holm, direction = _shown(primary, compared.measure, family, alpha)
    model_p_holm, model_direction = _shown(model, compared.measure, family, alpha)
    return Conclusion(
        hypothesis=hypothesis,
        measure=compared.measure,
        primary=primary,
        p_holm=p_holm,
        direction=direction,
        supported=direction == EXPECTED[compared.measure],
        model=model,
        model_p_holm=model_p_holm,
        model_direction=model_direction,
        equivalence=_equivalence(primary, plan) if direction == "none" else None,
    )


def _equivalence(primary: TestResult, plan: Plan) -> Equivalence | None:
    """Test what can be excluded, at the plan's alpha and not by Holm.

    Holm's correction keeps down the chance that any of the family shows a difference where there is
    none. What is excluded is said of one measure, with the interval that goes with it.
    """
    smallest_effect = plan.smallest_effects.get(SMALLEST_EFFECT_KEYS[primary.unit])
    return None if smallest_effect is None else two_one_sided(primary, smallest_effect, plan.alpha)


def _tested_p(test: TestResult) -> float | None:
    """Return p, None where all values are equal: of these, 1 is no verdict."""
    return None if CONSTANT_OUTCOME in test.warnings else test.p


def _shown(
    test: TestResult | None, measure: str, family: Mapping[str, float | None], alpha: float
) -> tuple[float | None, Direction]:
    """Return p by Holm, the other measures tested by their primary tests, and what it shows."""
    p = None if test is None else _tested_p(test)
    if test is None or p is None or test.estimate is None:
        return None, "undefined"
    p_holm = None
    if measure in family:
        tested = {**family, measure: p}
        p_holm = dict(zip(tested, holm(list(tested.values())), strict=True))[measure]
    if (p if p_holm is None else p_holm) >= alpha:
        return p_holm, "none"
    return p_holm, "more" if test.estimate > test.null else "less"
