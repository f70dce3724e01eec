"""What the plan's primary tests answer, with Holm's correction and the model beside them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from .methods import MODELS, Comparison
from .plan import Plan
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


@dataclass(frozen=True)
class Conclusion:
    """What one measure says of its hypothesis.

    `direction` is what was shown of the treatment arm at the plan's alpha, and is concluded from
    `primary` alone, by `p_holm` where the measure is of the family (None elsewhere). `model` is the
    mixed model beside it, None where there is none; `models_agree` tells whether both fall on the
    same side of alpha, uncorrected.
    """

    hypothesis: str
    measure: str
    primary: TestResult
    p_holm: float | None
    direction: Direction
    supported: bool
    model: TestResult | None
    models_agree: bool | None


def conclude(plan: Plan, comparisons: Mapping[str, Comparison]) -> tuple[Conclusion, ...]:
    """Answer each hypothesis of the plan, in its order."""
    corrected = dict(
        zip(
            plan.holm_family,
            holm([comparisons[measure].primary.p for measure in plan.holm_family]),
            strict=True,
        )
    )
    return tuple(
        _conclusion(plan.alpha, each.hypothesis, comparisons[each.measure], corrected)
        for each in plan.primary
    )


def _conclusion(
    alpha: float, hypothesis: str, compared: Comparison, corrected: Mapping[str, float | None]
) -> Conclusion:
    primary = compared.primary
    p_holm = corrected.get(compared.measure)
    direction = _direction(primary, p_holm if compared.measure in corrected else primary.p, alpha)
    model = next(filter(None, (compared.results.get(key) for key in MODELS)), None)
    agree = None
    if model is not None and model.p is not None and primary.p is not None:
        agree = (model.p < alpha) == (primary.p < alpha)
    return Conclusion(
        hypothesis=hypothesis,
        measure=compared.measure,
        primary=primary,
        p_holm=p_holm,
        direction=direction,
        supported=direction == EXPECTED[compared.measure],
        model=model,
        models_agree=agree,
    )


def _direction(primary: TestResult, p: float | None, alpha: float) -> Direction:
    if p is None or primary.estimate is None:
        return "undefined"
    if p >= alpha:
        return "none"
    return "more" if primary.estimate > primary.null else "less"
