"""Fixed effects beside the arm, and what a model adjusted for them says."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .outcome import Numbers
from .result import TestResult

_ALIASED = 1e-8
"""A column of which less is left, once others are taken out, is a combination of them."""


@dataclass(frozen=True, eq=False)
class Covariates:
    """What N trials differ in besides the arm: `values`, shape (N, K), a column for each term."""

    terms: tuple[str, ...]
    values: Numbers

    def of(self, trials: NDArray[np.bool_]) -> Covariates:
        """Return those of some trials, a mask of shape (N,)."""
        return Covariates(self.terms, self.values[trials])

    def estimable(self, treated: NDArray[np.bool_]) -> tuple[Covariates, tuple[str, ...]]:
        """Leave out, and name, terms that are the same everywhere or follow from arm and others."""
        arm = treated - treated.mean()
        space = [arm / np.linalg.norm(arm)]
        places = []
        for place, column in enumerate(self.values.T):
            left = column - column.mean()
            for axis in space:
                left = left - (left @ axis) * axis
            size = np.linalg.norm(left)
            if size > _ALIASED * np.linalg.norm(column):
                space.append(left / size)
                places.append(place)
        kept = tuple(self.terms[place] for place in places)
        aliased = tuple(term for term in self.terms if term not in kept)
        return Covariates(kept, self.values[:, places]), aliased


@dataclass(frozen=True, kw_only=True)
class Coefficient(TestResult):
    """What one unit more of a covariate, or its presence, changes; `term` says of which."""

    term: str


@dataclass(frozen=True)
class Adjusted:
    """A model with covariates: `effect` is that of the arm, all else equal.

    `aliased` names the terms that the trials cannot tell from the arm or others, left out.
    """

    effect: TestResult
    coefficients: tuple[Coefficient, ...]
    aliased: tuple[str, ...]
