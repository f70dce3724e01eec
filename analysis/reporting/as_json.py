"""The report for programs: every estimate at full precision, with unit, n used and n missing."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from ..conclusions import Conclusion
from ..evidence import Evidence
from ..methods import INDEPENDENT, Comparison
from ..results import Results

SCHEMA_VERSION = 3
"""Rises when a field is renamed, moved or changes its meaning."""


def as_json(results: Results) -> dict[str, Any]:
    """Return the content of report.json: text, numbers, true, false and null, no NaN."""
    data, evidence, plan = results.data, results.evidence, results.data.plan
    mapping = data.mapping
    content = {
        "schema_version": SCHEMA_VERSION,
        "inputs": data.sources,
        "packages": results.packages,
        "seed": plan.seed,
        "plan": {"file": plan.file, "sha256": plan.sha256, **plan.content},
        "mapping": {"file": mapping.file, "sha256": mapping.sha256, **mapping.content},
        "selection": {
            "with_simulated": data.with_simulated,
            "simulated_trials": data.simulated,
            "preview_trials": data.preview,
            "other_conditions": data.other_conditions,
            "excluded": [
                {"rule": each.exclusion.rule, "participants": each.participants}
                for each in data.excluded
            ],
            "columns_renamed": dict(data.renamed),
            "confidence_scale": data.confidence_scale,
        },
        "flow": data.flow,
        "conclusions": [_conclusion(each, evidence) for each in evidence.conclusions],
        "measures": {
            measure: _comparison(compared) for measure, compared in evidence.comparisons.items()
        },
        "likeness_of_trials": evidence.likeness,
        "time_to_correct_stop": {
            "two_way_cox": evidence.two_way_cox,
            "cox": evidence.cox,
            "cumulative_incidence": evidence.incidence,
        },
        "adjusted_for_covariates": evidence.adjustment,
        "against_chance": _by_arm(evidence.chance, chance_level=plan.chance_level),
        "accuracy": {
            "by_confidence": evidence.by_confidence,
            "by_stop_time": evidence.by_time,
            "discrimination_by_confidence": _by_arm(evidence.discrimination),
        },
        "sensitivity": evidence.sensitivity,
        "by_exclusion_rule": evidence.exclusions,
        "by_device": evidence.devices,
        "as_in_paper": {"trials_treated_as_independent": True, **_fields(evidence.paper)},
        "warnings": results.notices,
    }
    plain: dict[str, Any] = _plain(content)
    return plain


def _comparison(compared: Comparison) -> dict[str, Any]:
    treatment, reference = compared.means
    return {
        "unit": compared.unit,
        "means": {"treatment": treatment, "reference": reference},
        "primary": compared.primary_key,
        "methods": {
            key: {"trials_treated_as_independent": key in INDEPENDENT, **_fields(result)}
            for key, result in compared.results.items()
        },
        "left_out": compared.left_out,
        "superiority": compared.superiority,
    }


def _conclusion(conclusion: Conclusion, evidence: Evidence) -> dict[str, Any]:
    return {
        "hypothesis": conclusion.hypothesis,
        "measure": conclusion.measure,
        "test": evidence.comparisons[conclusion.measure].primary_key,
        "p": conclusion.primary.p,
        "p_holm": conclusion.p_holm,
        "direction": conclusion.direction,
        "supported": conclusion.supported,
        "model_p_holm": conclusion.model_p_holm,
        "model_direction": conclusion.model_direction,
        "model_agrees": conclusion.models_agree,
        "equivalence": conclusion.equivalence,
    }


def _by_arm(results: Sequence[object], **others: object) -> dict[str, object]:
    treatment, reference = results
    return {"treatment": treatment, "reference": reference, **others}


def _fields(value: Any) -> dict[str, Any]:
    return {field.name: getattr(value, field.name) for field in fields(value)}


def _plain(value: Any) -> Any:
    """Turn results into what JSON knows; what is not finite is null."""
    if is_dataclass(value) and not isinstance(value, type):
        return _plain(_fields(value))
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
