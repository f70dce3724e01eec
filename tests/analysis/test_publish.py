"""The files of a report: all there, nothing half-written, the same bytes again."""

import json
import re

import pytest

from analysis import TRIALS, AnalysisError, analyse_path, write_report, write_table
from analysis.reporting import drawings
from tests.analysis.rows import trial_row

STEMS = {
    "flow",
    "incidence",
    "accuracy_by_time",
    "calibration",
    "confidence_levels",
    *(
        f"{kind}{measure}"
        for kind in ("", "raincloud_", "slopes_", "forest_")
        for measure in ("correct", "prediction_time", "confidence")
    ),
}


def silent(_what):
    """Progress that no one looks at."""


@pytest.fixture
def one_figure(monkeypatch):
    """Draw the first figure only, where figures are not what is tested."""
    all_of_them = drawings.drawings
    monkeypatch.setattr(drawings, "drawings", lambda *given: [next(all_of_them(*given))])


def test_each_figure_is_there_as_svg_png_and_data(written):
    found = {path.name for path in (written / "figures").iterdir()}
    assert found == {f"{stem}.{suffix}" for stem in STEMS for suffix in ("svg", "png", "csv")}
    for path in (written / "figures").glob("*.png"):
        assert path.read_bytes().startswith(b"\x89PNG")


def test_the_markdown_links_every_figure_with_a_text_for_who_does_not_see_it(written):
    links = re.findall(r"!\[(.+)\]\(figures/(\w+)\.svg\)", (written / "report.md").read_text())
    assert {stem for _, stem in links} == STEMS
    for text, stem in links:
        assert len(text) > 20, stem


def test_the_page_holds_every_figure_and_needs_no_other_file(written):
    page = (written / "report.html").read_text()
    assert page.count("<svg ") == page.count('role="img"') == len(STEMS)
    assert not re.search(r"https?:|<script|<link|<img|@import|url\((?!#)", page)
    ids = re.findall(r'\bid="([^"]+)"', page)
    assert len(ids) == len(set(ids))


def test_sentences_for_a_manuscript_have_their_own_file(written):
    text = (written / "apa.txt").read_text()
    assert "\nCorrect guesses: 84.9 % correct with" in text
    assert text.startswith("Not a result: synthetic data, made to print the paper's numbers.\n")


def test_two_trials_are_enough_for_a_whole_report(tmp_path):
    rows = [trial_row("P1", 1, "polmdp"), trial_row("P2", 1, "optimal")]
    path = write_table(TRIALS, rows, tmp_path)[0]
    write_report(analyse_path(path), tmp_path / "report", silent)
    assert {file.stem for file in (tmp_path / "report" / "figures").iterdir()} == STEMS


@pytest.mark.usefixtures("one_figure")
def test_the_same_data_give_the_same_bytes(export, tmp_path):
    for name in ("one", "two"):
        write_report(analyse_path(export), tmp_path / name, silent)
    files = [path.relative_to(tmp_path / "one") for path in (tmp_path / "one").rglob("*.*")]
    assert len(files) == 7
    for file in files:
        one, two = ((tmp_path / name / file).read_bytes() for name in ("one", "two"))
        assert one == two, file


@pytest.mark.usefixtures("one_figure")
def test_a_second_report_replaces_the_first_and_spares_other_files(export, tmp_path):
    results = analyse_path(export)
    folder = tmp_path / "report"
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    (folder / "report.json").write_text("old")
    write_report(results, folder, silent)
    assert (folder / "notes.txt").read_text() == "mine"
    assert json.loads((folder / "report.json").read_text())["schema_version"] == 3


def folders_while_writing(results, folder):
    """What lies beside `folder` at each step of writing a report into it."""
    seen = set()
    write_report(results, folder, lambda _what: seen.update(folder.parent.iterdir()))
    return seen


@pytest.mark.usefixtures("one_figure")
def test_a_folder_that_is_there_is_written_without_touching_the_one_around_it(export, tmp_path):
    folder = tmp_path / "shared" / "report"
    folder.mkdir(parents=True)
    assert folders_while_writing(analyse_path(export), folder) == {folder}
    assert {path.name for path in folder.iterdir()} == {
        *("report.html", "report.json", "report.md", "apa.txt", "figures")
    }


@pytest.mark.usefixtures("one_figure")
def test_a_folder_that_is_not_there_yet_appears_when_the_report_is_whole(export, tmp_path):
    folder = tmp_path / "shared" / "report"
    assert folder not in folders_while_writing(analyse_path(export), folder)
    assert list(folder.parent.iterdir()) == [folder]


def test_a_folder_that_cannot_be_made_is_named_as_it_was_asked_for(export, tmp_path):
    (tmp_path / "taken").write_text("mine")
    folder = tmp_path / "taken" / "report"
    with pytest.raises(AnalysisError) as caught:
        write_report(analyse_path(export), folder, silent)
    assert str(caught.value).startswith(f"{folder}: expected a folder to write to")


def test_a_report_that_fails_half_way_leaves_nothing(export, tmp_path):
    def interrupted(_what):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_report(analyse_path(export), tmp_path / "reports" / "one", interrupted)
    assert not list((tmp_path / "reports").iterdir())
    (tmp_path / "reports" / "one").mkdir()
    with pytest.raises(KeyboardInterrupt):
        write_report(analyse_path(export), tmp_path / "reports" / "one", interrupted)
    assert not list((tmp_path / "reports" / "one").iterdir())


@pytest.mark.usefixtures("one_figure")
def test_a_file_in_the_way_of_the_report_is_one_clear_error(export, tmp_path):
    (tmp_path / "taken").write_text("mine")
    with pytest.raises(AnalysisError, match="expected a folder to write to"):
        write_report(analyse_path(export), tmp_path / "taken", silent)
    assert (tmp_path / "taken").read_text() == "mine"
