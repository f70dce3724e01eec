"""The primary results by the device on which participants took part."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import polars as pl

from .contract import PARTICIPANTS, POINTER_TYPES, TRIALS
from .dataset import Dataset
from .selections import Selection, Selector

UNKNOWN = "not known"


@dataclass(frozen=True)
class Trait:
    """What can differ between devices, and its classes; everybody is of the first that holds.

    The conditions are seen over all rows of a participant in `table`; where none holds, the class
    is not known.
    """

    classes: Mapping[str, pl.Expr]
    table: str = PARTICIPANTS.name


@dataclass(frozen=True)
class DeviceGroup:
    """The participants of one class of a trait, `UNKNOWN` at the end, and their primary tests."""

    trait: str
    group: str
    selection: Selection


@dataclass(frozen=True)
class Devices:
    """Groups of those analysed, trait by trait; each of them is in one group of a trait.

    `left_out` says of the traits that the tables do not tell why.
    """

    groups: tuple[DeviceGroup, ...]
    left_out: Mapping[str, str]


_WIDTH, _RATE = (pl.col(name).first() for name in ("viewport_width", "refresh_rate_hz"))
_REDUCED = pl.col("reduced_motion")
_DROPPED_PER_S = pl.col("frames_dropped").mean() / pl.col("stop_time_s").mean()

TRAITS = {
    "pointer": Trait({each: pl.col("pointer_type").first() == each for each in POINTER_TYPES}),
    "width of the page": Trait(
        {
            "below 600 px": _WIDTH < 600,
            "600 to 1,023 px": _WIDTH < 1024,
            "1,024 px or more": _WIDTH >= 1024,
        }
    ),
    "reduced motion": Trait(
        {
            "on": _REDUCED.all(ignore_nulls=False),
            "off": ~_REDUCED.any(ignore_nulls=False),
            "changed": _REDUCED.any() & ~_REDUCED.all(),
        },
        TRIALS.name,
    ),
    "refresh rate": Trait(
        {
            "below 50 Hz": _RATE < 50,
            "50 to below 70 Hz": _RATE < 70,
            "70 Hz or more": _RATE >= 70,
        }
    ),
    "frames dropped": Trait(
        {
            "none": _DROPPED_PER_S == 0,
            "up to 1 a second": _DROPPED_PER_S <= 1,
            "more than 1 a second": _DROPPED_PER_S > 1,
        },
        TRIALS.name,
    ),
}
"""Phones are below 600 px wide, most tablets below 1,024; 60 Hz is the usual rate of screens."""


def by_device(data: Dataset, selector: Selector) -> Devices:
    """Repeat the primary tests within each class of each trait."""
    left_out = {name: reason for name, trait in TRAITS.items() if (reason := _lacking(trait, data))}
    groups = (
        group
        for name, trait in TRAITS.items()
        if name not in left_out
        for group in _groups(name, trait, data, selector)
    )
    return Devices(tuple(groups), left_out)


def _groups(name: str, trait: Trait, data: Dataset, selector: Selector) -> Iterator[DeviceGroup]:
    classed = pl.coalesce(
        *(pl.when(holds).then(pl.lit(each)) for each, holds in trait.classes.items()),
        pl.lit(UNKNOWN),
    )
    rows = _rows(trait, data)
    assert rows is not None
    found = rows.group_by("participant").agg(classed.alias("class"))
    for each in (*trait.classes, UNKNOWN):
        people = selector.analysed.intersection(
            found.filter(pl.col("class") == each)["participant"]
        )
        if people:
            yield DeviceGroup(name, each, selector.only(people))


def _lacking(trait: Trait, data: Dataset) -> str:
    """Say which column of which table the trait needs and finds missing; else an empty text."""
    rows = _rows(trait, data)
    if rows is None:
        return f"there is no table {trait.table}"
    needed = {name for holds in trait.classes.values() for name in holds.meta.root_names()}
    missing = sorted(needed - set(rows.columns))
    return f"there is no column {', '.join(missing)} in the table {trait.table}" if missing else ""


def _rows(trait: Trait, data: Dataset) -> pl.DataFrame | None:
    return data.trials if trait.table == TRIALS.name else data.participants
