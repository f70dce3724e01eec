"""The models adjusted for the plan's covariates, each beside the same model without them."""

from __future__ import annotations

from collections.abc import Iterator

from ..adjustment import TIME_TO_STOP, Adjustment
from ..evidence import Evidence
from ..methods import MODELS
from ..plan import Plan
from ..statistics.covariates import Adjusted
from ..statistics.result import TestResult
from ..warning_texts import WARNINGS
from ..wording import capital
from .answers import WORDS
from .document import Grid, Heading, Items, Paragraph, Part, with_reason
from .method_tables import HEADER, LACKING, result_row

_HOW = (
    "The tests on which hypotheses are judged stay unadjusted. Here the models beside them stand "
    "without and with the plan's covariates, which enter as fixed effects: adjusted, the arms are "
    "compared at equal values of them. Below the arms stand the covariates' own coefficients."
)


def adjusted_parts(evidence: Evidence, plan: Plan) -> list[Part]:
    """Return the adjusted models, nothing where the plan names no covariates."""
    adjustment = evidence.adjustment
    if adjustment is None:
        return []
    arms = f"{plan.arms.treatment.label} against {plan.arms.reference.label}"
    parts: list[Part] = [Heading("Adjusted for covariates", 3), Paragraph(_HOW)]
    for key, model in adjustment.models.items():
        rows = (
            result_row(f"{arms}, unadjusted", _unadjusted(evidence, key), plan.alpha),
            result_row(f"{arms}, adjusted", model.effect, plan.alpha),
            *(result_row(each.term, each, plan.alpha) for each in model.coefficients),
        )
        parts += with_reason(Grid(_caption(key), HEADER, rows), LACKING)
    notes = tuple(f"{capital(note)}." for note in _notes(adjustment))
    return [*parts, Items(notes)] if notes else parts


def _unadjusted(evidence: Evidence, key: str) -> TestResult:
    """Return the same model without covariates."""
    if key == TIME_TO_STOP:
        return evidence.two_way_cox
    results = evidence.comparisons[key].results
    return next(results[model] for model in MODELS if model in results)


def _notes(adjustment: Adjustment) -> Iterator[str]:
    yield from adjustment.notes
    for key, model in adjustment.models.items():
        yield from (f"{_name(key)}: {each}" for each in _of_model(model))
    for key, reason in adjustment.left_out.items():
        yield f"{_name(key)}: left out, {reason}"


def _of_model(model: Adjusted) -> Iterator[str]:
    for term in model.aliased:
        yield f"{term} cannot be told from other terms or the condition, and is left out"
    yield from (WARNINGS[code] for code in model.effect.warnings)


def _caption(key: str) -> str:
    kind = "Cox regression" if key == TIME_TO_STOP else "mixed model"
    return f"{capital(_name(key))}: {kind}, unadjusted and adjusted"


def _name(key: str) -> str:
    return "time to a correct stop" if key == TIME_TO_STOP else WORDS[key].name
