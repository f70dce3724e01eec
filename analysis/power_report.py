"""The files of a power simulation: its table, its figure, and everything it rests on."""

from __future__ import annotations

import json
from dataclasses import asdict
from importlib import metadata
from pathlib import Path

from .figures.drawn import write_figure
from .figures.power import figure_power, power_table
from .files import folder_for_writing, replacing
from .power import UNCORRECTED, Power
from .simulated_studies import ALPHA

SCHEMA_VERSION = 2
"""Of power.json: rises when a field is renamed, moved or changes its meaning."""

_PACKAGES = ("goalguess", "numpy", "scipy", "statsmodels")


def write_power(power: Power, folder: Path) -> None:
    """Write `folder`/power.json, .csv, .svg and .png; AnalysisError if it cannot be written to."""
    content = {
        "schema_version": SCHEMA_VERSION,
        "packages": {name: metadata.version(name) for name in _PACKAGES},
        "question": asdict(power.question),
        "points": power_table(power).to_dicts(),
        "curves": {test: asdict(power.curve(test)) for test in power.question.tests},
        "alpha": ALPHA,
        "uncorrected": UNCORRECTED,
        "needed": [asdict(each) for each in power.needed],
    }
    with folder_for_writing(folder):
        with replacing(folder / "power.json") as path:
            path.write_text(json.dumps(content, indent=2, allow_nan=False) + "\n", encoding="utf-8")
        write_figure(figure_power(power), folder, "power")
