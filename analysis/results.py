"""From a path to everything one analysis knows."""

from __future__ import annotations

import platform
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

from .data_notices import Notice
from .dataset import Dataset
from .evidence import Evidence, gather
from .mapping import TableMapping
from .notices import notices
from .plan import Plan
from .reader import read_dataset

_PACKAGES = ("goalguess", "numpy", "scipy", "polars", "statsmodels", "matplotlib")


@dataclass(frozen=True)
class Results:
    """The data, the numbers, what to mind, the software."""

    data: Dataset
    evidence: Evidence
    notices: list[Notice]
    packages: dict[str, str]


def analyse_path(
    path: Path,
    plan: Plan | None = None,
    mapping: TableMapping | None = None,
    *,
    with_simulated: bool = False,
) -> Results:
    """Read, check and analyse an export folder or one file of trials, by the default plan if none.

    AnalysisError if the data cannot be analysed.
    """
    data = read_dataset(path, plan, mapping, with_simulated=with_simulated)
    evidence = gather(data)
    return Results(data, evidence, notices(data, evidence), _packages())


def _packages() -> dict[str, str]:
    found = {"python": platform.python_version()}
    for name in _PACKAGES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            # run from a checkout that is not installed
            found[name] = "not installed"
    return found
