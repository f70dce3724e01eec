"""From results to files that appear together or not at all."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable
from pathlib import Path

from .files import folder_for_writing, refusals_told
from .reporting.apa import apa_sentences
from .reporting.as_json import as_json
from .reporting.document import Picture
from .reporting.html import html
from .reporting.markdown import markdown
from .reporting.report import report_parts
from .results import Results

Pictures = dict[str, list[Picture]]
"""Figures that were drawn, by their section of the report."""


def write_report(results: Results, folder: Path, tell: Callable[[str], None]) -> None:
    """Write report.html, .md and .json, apa.txt, and figures/*.svg, *.png, *.csv into `folder`.

    All are made in a temporary folder first, inside `folder` or, while it is not there, beside it,
    so that a failure leaves `folder` as it was; other files in `folder` stay. `tell` hears what is
    being done. AnalysisError, naming `folder`, if it cannot be written to.
    """
    folder = folder.resolve()
    # inside a folder that is there, because the one around it may be read-only
    around = folder if folder.exists() else folder.parent
    with refusals_told(folder):
        around.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=f".{folder.name}.", dir=around) as made:
            _write_by_way_of(Path(made), results, folder, tell)


def _write_by_way_of(
    temporary: Path, results: Results, folder: Path, tell: Callable[[str], None]
) -> None:
    """Make all files in `temporary`, then move them to `folder`."""
    pictures = _draw(results, temporary / "figures", tell)
    tell("Writing the report")
    for name, content in _texts(results, pictures, temporary / "figures").items():
        (temporary / name).write_text(content, encoding="utf-8")
    with folder_for_writing(folder), folder_for_writing(folder / "figures"):
        for file in temporary.rglob("*"):
            if file.is_file():
                file.replace(folder / file.relative_to(temporary))


def _texts(results: Results, pictures: Pictures, figures: Path) -> dict[str, str]:
    """Return the content of each file of text; drawings are read from the folder `figures`."""
    parts = report_parts(results, pictures)
    drawn = {file.stem: file.read_text(encoding="utf-8") for file in figures.glob("*.svg")}
    as_text = json.dumps(as_json(results), indent=2, ensure_ascii=False, allow_nan=False)
    return {
        "report.html": html(parts, drawn),
        "report.md": markdown(parts),
        "report.json": as_text + "\n",
        "apa.txt": "\n".join(apa_sentences(results)) + "\n",
    }


def _draw(results: Results, folder: Path, tell: Callable[[str], None]) -> Pictures:
    """Draw all figures, one after the other, and return them by section."""
    from .figures import write_figure
    from .reporting.drawings import drawings

    folder.mkdir()
    pictures: Pictures = {}
    for each in drawings(results.data, results.evidence):
        tell(f"Drawing {each.name}")
        drawn = each.draw()
        write_figure(drawn, folder, each.name)
        pictures.setdefault(each.section, []).append(Picture(each.name, each.caption, drawn.alt))
    return pictures
