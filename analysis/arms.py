"""The two conditions that are compared."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Arm:
    """A condition as the data write it, and the label that reports and figures give it."""

    condition: str
    label: str


@dataclass(frozen=True)
class Arms:
    """Both conditions; everything that lists them lists the treatment first."""

    treatment: Arm
    reference: Arm

    @property
    def names(self) -> tuple[str, str]:
        """The conditions as the data write them."""
        return self.treatment.condition, self.reference.condition

    @property
    def labels(self) -> dict[str, str]:
        """The label of each condition, by its name in the data."""
        return {arm.condition: arm.label for arm in (self.treatment, self.reference)}
