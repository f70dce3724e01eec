"""What `power` and `level` read from their options; AnalysisError names the option."""

from __future__ import annotations

from collections.abc import Collection

from .crossed_model import Spread
from .errors import AnalysisError


def read_spread(text: str) -> Spread:
    """Read .8/.8/.4: SDs of participants, scenarios and scenario x condition, in logits."""
    try:
        participant, scenario, scenario_condition = map(float, text.split("/"))
    except ValueError as error:
        raise AnalysisError(
            f"--sds: expected participant/scenario/scenario x condition, as .8/.8/.4, got {text!r}"
        ) from error
    return Spread(participant, scenario, scenario_condition)


def read_spreads(text: str) -> tuple[Spread, ...]:
    """Read several of them with commas between."""
    return tuple(map(read_spread, text.split(",")))


def read_names(option: str, text: str, known: Collection[str]) -> tuple[str, ...]:
    """Read names with commas between, each one of `known` and none twice."""
    names = tuple(name.strip() for name in text.split(","))
    if not {*names} <= {*known} or len({*names}) < len(names):
        raise AnalysisError(
            f"{option}: expected some of {', '.join(known)} with commas between, got {text!r}"
        )
    return names


def read_arms(text: str) -> tuple[int, int]:
    """Read N, participants of both arms together, or N/M, those of each arm."""
    try:
        sizes = tuple(map(int, text.split("/")))
    except ValueError:
        sizes = ()
    match sizes:
        case (both,) if both % 2 == 0:
            return both // 2, both // 2
        case (treatment, reference):
            return treatment, reference
    raise AnalysisError(
        "--participants: expected an even number of both arms together, or N/M in each, as 8/32, "
        f"got {text!r}"
    )


def read_sizes(text: str) -> tuple[int, ...]:
    """Read numbers of participants with commas between."""
    try:
        return tuple(map(int, text.split(",")))
    except ValueError as error:
        raise AnalysisError(
            f"--participants: expected whole numbers with commas between, got {text!r}"
        ) from error
