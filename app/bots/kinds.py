"""The kinds of simulated participants, and how many of each come."""

from collections.abc import Mapping
from enum import StrEnum
from math import isfinite
from typing import TYPE_CHECKING

from app.errors import InvalidInput

if TYPE_CHECKING:  # the command line reads this file for its help, and must answer fast
    import numpy as np


class Kind(StrEnum):
    """What a simulated participant is like; all but the first four judge as the attentive do."""

    ATTENTIVE = "attentive"
    GUESSING = "guessing"
    SPEEDING = "speeding"
    NEVER_STOPPING = "never_stopping"
    DROPPING_OUT = "dropping_out"
    RELOADING = "reloading"
    DOUBLE_CLICKING = "double_clicking"
    TWO_TABS = "two_tabs"
    OFFLINE = "offline"
    RETURNING = "returning"
    WITHDRAWING = "withdrawing"


Mix = Mapping[Kind, float]

DEFAULT_MIX = "attentive=20," + ",".join(f"{kind}=1" for kind in list(Kind)[1:])


def read_mix(text: str) -> Mix:
    """The shares of a text such as attentive=8,guessing=1; InvalidInput names what is wrong."""
    mix: dict[Kind, float] = {}
    for part in text.split(","):
        name, _, share = part.strip().partition("=")
        try:
            mix[Kind(name)] = float(share or 1)
        except ValueError:
            raise InvalidInput(
                f"--mix: expected kinds of {', '.join(Kind)} like attentive=8,guessing=1; "
                f"came {part.strip()!r}"
            ) from None
    if not all(isfinite(share) and share >= 0 for share in mix.values()) or not any(mix.values()):
        raise InvalidInput(f"--mix: expected shares of 0 or more, not all 0; came {text!r}")
    return mix


def deal_kinds(mix: Mix, number: int, rng: "np.random.Generator") -> list[Kind]:
    """So many kinds in random order, as near to their shares as whole people can be."""
    total = sum(mix.values())
    exact = {kind: number * share / total for kind, share in mix.items()}
    counts = {kind: int(share) for kind, share in exact.items()}
    by_remainder = sorted(mix, key=lambda kind: counts[kind] - exact[kind])
    for kind in by_remainder[: number - sum(counts.values())]:
        counts[kind] += 1
    kinds = [kind for kind, count in counts.items() for _ in range(count)]
    return [kinds[i] for i in rng.permutation(number)]
