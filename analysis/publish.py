"""From a path to results, and from results to files that appear together or not at all."""

from __future__ import annotations

import json
import platform
import tempfile
from collections.abc import Callable
from dataclasses import asdict, dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

from .as_in_paper import PaperBlock, as_in_paper, values_of
from .data_notices import Notice
from .dataset import Dataset
from .document import Part, markdown
from .files import folder_for_writing
from .notices import notices
from .reader import read_dataset
from .report import report_parts

SCHEMA_VERSION = 1
"""Of report.json: rises when a field is renamed, moved or changes its meaning."""

_PACKAGES = ("goalguess", "numpy", "scipy", "polars", "matplotlib")


@dataclass(frozen=True)
class Results:
    """Everything one analysis knows: the data, the numbers, what to mind, the software."""

    data: Dataset
    block: PaperBlock
    notices: list[Notice]
    packages: dict[str, str]

    @property
    def parts(self) -> list[Part]:
        """The report, for `document.markdown` and `document.plain_text`."""
        return report_parts(self.data, self.block, self.notices, self.packages)


def analyse_path(path: Path, *, with_simulated: bool = False) -> Results:
    """Read, check and analyse an export folder or one file of trials.

    AnalysisError if the data cannot be analysed.
    """
    data = read_dataset(path, with_simulated=with_simulated)
    block = as_in_paper(data)
    return Results(data, block, notices(data, block), _packages())


def report_json(results: Results) -> dict[str, Any]:
    """Return the content of report.json: estimates at full precision, units in names or `unit`."""
    data = results.data
    return {
        "schema_version": SCHEMA_VERSION,
        "inputs": [asdict(source) for source in data.sources],
        "packages": results.packages,
        "selection": {
            "with_simulated": data.with_simulated,
            "simulated_trials": data.simulated,
            "preview_trials": data.preview,
            "columns_renamed": dict(data.renamed),
        },
        "as_in_paper": {"trials_treated_as_independent": True, **asdict(results.block)},
        "warnings": [asdict(notice) for notice in results.notices],
    }


def write_report(results: Results, folder: Path, tell: Callable[[str], None]) -> None:
    """Write report.json, report.md and figures/*.svg, *.png, *.csv into `folder`.

    All are made in a temporary folder beside it first, so that a failure leaves `folder` as it
    was; other files in `folder` stay. `tell` hears what is being done.
    """
    folder = folder.resolve()
    with (
        folder_for_writing(folder.parent),
        tempfile.TemporaryDirectory(prefix=f".{folder.name}.", dir=folder.parent) as made,
    ):
        temporary = Path(made)
        as_json = json.dumps(report_json(results), indent=2, ensure_ascii=False, allow_nan=False)
        (temporary / "report.json").write_text(as_json + "\n", encoding="utf-8")
        (temporary / "report.md").write_text(markdown(results.parts), encoding="utf-8")
        tell("Drawing the figures")
        _draw(results, temporary / "figures")
        with folder_for_writing(folder), folder_for_writing(folder / "figures"):
            for file in temporary.rglob("*"):
                if file.is_file():
                    file.replace(folder / file.relative_to(temporary))


def _draw(results: Results, folder: Path) -> None:
    from . import figures

    folder.mkdir()
    block, arms = results.block, results.data.arms
    labels = arms.treatment.label, arms.reference.label
    shares = list(block.correct.arms.values())
    times = list(block.prediction_time.arms.values())
    confidence = [values_of(results.data, arm, "confidence") for arm in arms.names]
    for name, drawn in {
        "correct": figures.figure_correct(shares, labels),
        "prediction_time": figures.figure_prediction_time(times, labels),
        "confidence": figures.figure_confidence(confidence, labels),
    }.items():
        figures.write_figure(drawn, folder, name)


def _packages() -> dict[str, str]:
    found = {"python": platform.python_version()}
    for name in _PACKAGES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            # run from a checkout that is not installed
            found[name] = "not installed"
    return found
