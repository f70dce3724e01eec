"""The plan's covariates: what they are of each trial, and the models that are adjusted for them.

A participant whose age or device is not known stays in, with a term of its own for that ("age not
told", at the mean age): all trials are kept, so that the adjusted model is of the same people as
the one beside it. Arms are dealt at random, so that this does not bias the difference between them,
which leaving people out may; what it does to the coefficient of age is not asked. Source: White and
Thompson (2005), Statistics in Medicine 24, 993-1007.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from .dataset import Dataset, outcome
from .methods import MODELS, Comparison
from .statistics.adjusted import adjusted_cox, adjusted_crossed
from .statistics.covariates import Adjusted, Covariates
from .statistics.outcome import Numbers
from .statistics.survival import Stops

Flags = NDArray[np.bool_]

TIME_TO_STOP = "time_to_correct_stop"
"""The key of the adjusted Cox regression, beside the measures of the mixed models."""

FEWEST = 5
"""With fewer participants, what sets them apart is not told from what they are like."""

_NOT_TOLD = "not told"


@dataclass(frozen=True)
class Adjustment:
    """Models adjusted for the plan's covariates, by measure or `TIME_TO_STOP`.

    `notes` say what is not adjusted for, or not as a reader may expect, and why; `left_out` of
    measures whose model is not run why.
    """

    models: Mapping[str, Adjusted]
    left_out: Mapping[str, str]
    notes: tuple[str, ...]


@dataclass(frozen=True)
class _Terms:
    """Columns of all trials by what they are called, and what is to be said of them."""

    columns: Mapping[str, Numbers]
    notes: tuple[str, ...] = ()


def adjust(
    data: Dataset, comparisons: Mapping[str, Comparison], stops: Stops, ended: Flags
) -> Adjustment | None:
    """Fit the mixed models and the Cox regression again, with the plan's covariates.

    None where the plan names none. `ended`, shape (N,), marks the trials that `stops` has.
    """
    if not data.plan.covariates:
        return None
    found = [_TERMS[name](data) for name in data.plan.covariates]
    notes = [note for terms in found for note in terms.notes]
    columns = {name: column for terms in found for name, column in terms.columns.items()}
    values = np.stack([*columns.values()], axis=1) if columns else np.empty((len(ended), 0))
    covariates, aliased = Covariates(tuple(columns), values).estimable(
        data.trials["treated"].to_numpy()
    )
    notes += [
        f"{term}: not adjusted for, the same in all trials, or told by other terms or the condition"
        for term in aliased
    ]
    if not covariates.terms:
        return Adjustment({}, {}, tuple(notes))
    models, left_out = {}, {}
    for measure, compared in comparisons.items():
        for model in MODELS:
            if model in compared.results:
                models[measure] = adjusted_crossed(outcome(data, measure), covariates)
            elif model in compared.left_out:
                left_out[measure] = compared.left_out[model]
    models[TIME_TO_STOP] = adjusted_cox(stops, covariates.of(ended))
    return Adjustment(models, left_out, tuple(notes))


def _trial_order(data: Dataset) -> _Terms:
    """Place of the trial in the participant's list, centred: what a trial more changes."""
    place = data.trials["trial_index"].cast(pl.Float64).to_numpy()
    return _Terms({"trial order, per trial": place - place.mean()})


def _age(data: Dataset) -> _Terms:
    """Age in years, centred at the mean of the trials whose participant's is known."""
    ages = _of_participants(data, "age")
    if ages is None:
        return _unknown("age")
    years = ages.cast(pl.Float64)
    columns = {"age, per year": (years - years.mean()).fill_null(0.0).to_numpy()}
    lacking = _participants(data, ages.is_null())
    if not lacking:
        return _Terms(columns)
    note = (
        f"age: participants who did not tell theirs: {lacking}; their trials count at the mean age"
    )
    if lacking < FEWEST:
        return _Terms(columns, (f"{note}, too few for a term of their own",))
    columns["age not told"] = ages.is_null().cast(pl.Float64).to_numpy()
    return _Terms(columns, (f"{note}, with a term of their own",))


def _device(data: Dataset) -> _Terms:
    """Type of pointer, each against the most frequent one."""
    pointers = _of_participants(data, "pointer_type")
    if pointers is None:
        return _unknown("device")
    pointers = pointers.fill_null(_NOT_TOLD)
    sizes = {each: _participants(data, pointers == each) for each in pointers.unique().sort()}
    reference, *others = sorted(sizes, key=lambda each: -sizes[each])
    rare = [each for each in others if sizes[each] < FEWEST]
    return _Terms(
        {
            f"device: {each} against {reference}": (pointers == each).cast(pl.Float64).to_numpy()
            for each in others
            if each not in rare
        },
        tuple(
            f"device: {each} is too rare to be estimated (participants: {sizes[each]}) and counts "
            f"as {reference}"
            for each in rare
        ),
    )


def _of_participants(data: Dataset, column: str) -> pl.Series | None:
    """Return a column of the participants' table for each trial; None if nothing is known."""
    if data.participants is None:
        return None
    people = data.participants.select("participant", column)
    joined = data.trials.select("participant").join(
        people, on="participant", how="left", maintain_order="left"
    )
    return joined[column] if joined[column].count() else None


def _participants(data: Dataset, of: pl.Series) -> int:
    """Count the participants of the trials marked."""
    return data.trials["participant"].filter(of).n_unique()


def _unknown(name: str) -> _Terms:
    return _Terms({}, (f"{name}: not adjusted for, because the data do not have it",))


_TERMS: Mapping[str, Callable[[Dataset], _Terms]] = {
    "trial_order": _trial_order,
    "age": _age,
    "device": _device,
}
"""By the names of `plan.COVARIATES`."""
