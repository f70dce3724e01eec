"""The measures as figures show them: title, unit, range of the axis, width of a bin."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
import polars as pl
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Scale:
    """How a column of trials is shown: multiplied by `factor`, in `unit`, from 0 or `ends`.

    `ends` are those of the scale, `tick` and `bin` its steps and the width of a histogram's bin;
    None for a measure that ends where the data do.
    """

    column: str
    title: str
    in_words: str
    unit: str
    decimals: int
    factor: float = 1
    ends: tuple[float, float] | None = None
    tick: float | None = None
    bin: float | None = None

    @property
    def value(self) -> pl.Expr:
        """The column in the scale's unit, null where missing."""
        return pl.col(self.column).cast(pl.Float64).fill_nan(None) * self.factor

    def write(self, value: float) -> str:
        """Write a value with its unit."""
        return f"{value:.{self.decimals}f} {self.unit}".rstrip()

    def range(self, largest: float) -> tuple[float, float]:
        """Return the ends of the axis for data that end at `largest`."""
        return self.ends or (0.0, largest or 1.0)

    def edges(self, largest: float) -> NDArray[np.float64]:
        """Return the edges of a histogram's bins; those of a scale are centred on its ends."""
        low, high = self.range(largest)
        if self.bin is None:
            return np.linspace(low, high, 41)
        half = self.bin / 2
        return np.arange(low - half, high + self.bin, self.bin)

    def mark(self, axes: Axes, axis: Literal["x", "y"], largest: float = 0) -> None:
        """Set limits with room at the ends, ticks and label of an axis for data to `largest`."""
        low, high = self.range(largest)
        room = max((self.bin or 0) / 2, 0.03 * (high - low))
        axes.set(
            **{
                f"{axis}lim": (low - room, high + room),
                f"{axis}label": f"{self.title}, {self.unit}" if self.unit else self.title,
            }
        )
        if self.tick is None:
            axes.locator_params(axis, nbins=6, steps=[1, 2, 5, 10])
        else:
            axes.set(**{f"{axis}ticks": np.arange(low, high + self.tick / 2, self.tick)})


CORRECT = Scale(
    "correct",
    "Correct guesses",
    "share of correct guesses",
    "%",
    1,
    factor=100,
    ends=(0, 100),
    tick=20,
    bin=10,
)
PREDICTION_TIME = Scale("prediction_time_s", "Time of prediction", "time of prediction", "s", 2)
STOP_TIME = Scale("stop_time_s", "Time of the stop", "time of the stop", "s", 2)


def confidence_scale(low: float, high: float) -> Scale:
    """Return the scale of ratings from `low` to `high`."""
    span = high - low
    return Scale(
        "confidence",
        f"Confidence, {low:g} to {high:g} (surest)",
        f"confidence from {low:g} to {high:g}",
        "",
        2,
        ends=(low, high),
        tick=1 if span <= 10 else span / 5,
        # on 1 to 7, where means of ten ratings are tenths, each bin holds five of these
        bin=span / 12,
    )


CONFIDENCE = confidence_scale(1, 7)
