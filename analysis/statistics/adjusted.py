"""Mixed models and Cox regression of the arm with covariates as further fixed effects."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from .covariates import Adjusted, Coefficient, Covariates
from .cox import coefficient_test, fitted, result_of
from .crossed_test import crossed_test
from .inference import Inference, student, undefined
from .outcome import Outcome
from .result import TestResult
from .survival import Stops


def adjusted_crossed(
    outcome: Outcome, covariates: Covariates, interaction: bool = True
) -> Adjusted:
    """Test the arm as crossed_logistic and crossed_ordinal do, other things equal.

    `covariates` are of all trials of `outcome`. The model of two different values is logistic, of
    more cumulative logit. The arm's test is by t on the same degrees of freedom as without
    covariates, and so are the coefficients'. Source: Agresti (2010), chapter 10; agrees with R
    glmmTMB and ordinal::clmm.
    """
    beside, aliased = covariates.of(~np.isnan(outcome.y)).estimable(outcome.present().treated)
    effect, fit = crossed_test(
        outcome,
        interaction=interaction,
        method=f"Crossed mixed model on the logit scale, adjusted for {', '.join(beside.terms)}",
        source="Agresti (2010); agrees with R glmmTMB and, without scenarios within arms, "
        "ordinal::clmm",
        covariates=beside.values,
    )
    if fit is None:
        return Adjusted(effect, (), aliased)
    df = effect.df if isinstance(effect.df, int | float) else None
    inferences = (
        undefined(value, 0.0) if df is None else student(value, 0.0, se**2, df)
        for value, se in zip(fit.covariates.tolist(), fit.covariate_ses.tolist(), strict=True)
    )
    return Adjusted(effect, _coefficients(effect, beside, inferences), aliased)


def adjusted_cox(stops: Stops, covariates: Covariates) -> Adjusted:
    """Test the arm as two_way_cox does, other things equal; `covariates` are of the stops.

    Coefficients are tested as the arm is, clustered by participant and scenario.
    """
    beside, aliased = covariates.estimable(stops.treated)
    fit, reason = fitted(stops, beside.values)
    effect = result_of(stops, fit, reason, f", adjusted for {', '.join(beside.terms)}")
    if fit is None:
        return Adjusted(effect, (), aliased)
    inferences = (coefficient_test(stops, fit, 1 + place) for place in range(len(beside.terms)))
    return Adjusted(effect, _coefficients(effect, beside, inferences), aliased)


def _coefficients(
    effect: TestResult, covariates: Covariates, inferences: Iterable[Inference]
) -> tuple[Coefficient, ...]:
    """Return the coefficients of a model, in unit and trials as its effect of the arm."""
    shared: dict[str, Any] = {
        name: getattr(effect, name) for name in ("unit", "n", "n_missing", "method", "source")
    }
    return tuple(
        Coefficient(term=term, **shared, **_inferred(inference))
        for term, inference in zip(covariates.terms, inferences, strict=True)
    )


def _inferred(inference: Inference) -> dict[str, Any]:
    """Return what every inference has, without what those of clustered estimates have besides."""
    return {name: value for name, value in inference.items() if name in Inference.__annotations__}
