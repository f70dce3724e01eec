"""The report: the answer first, everything in it, nothing half-written, the same bytes again."""

import hashlib
import json
import re

import pytest

from analysis import PARTICIPANTS, TRIALS, AnalysisError, analyse_path, write_table
from analysis.document import Grid, Heading, Items, Paragraph, Part, Picture, markdown, plain_text
from analysis.publish import report_json, write_report
from tests.analysis.rows import as_csv, participants_of, six_participants, trial_row


def silent(_what):
    """Progress that no one looks at."""


@pytest.fixture(scope="module")
def paper(paper_fixture):
    """Results of the synthetic trials."""
    return analyse_path(paper_fixture)


@pytest.fixture(scope="module")
def written(paper, tmp_path_factory):
    """The folder with the report on the synthetic trials."""
    folder = tmp_path_factory.mktemp("reports") / "report"
    write_report(paper, folder, silent)
    return folder


def codes(path, **options):
    return [notice.code for notice in analyse_path(path, **options).notices]


@pytest.mark.parametrize("render", [markdown, plain_text])
def test_it_says_the_papers_numbers_in_both_renderings(paper, render):
    text = render(paper.parts)
    for said in (
        "chi2(1) = 48.864, p < .001",
        "U = 177976, p < .001",
        "U = 231203, p = .001",
        "15.67 s with PoLMDP, 18.22 s with optimal",
        "6.08 with PoLMDP, 5.78 with optimal",
        "84.9 % with PoLMDP, 69.6 % with optimal",
    ):
        assert said in text


def test_the_answer_comes_before_any_table(paper):
    text = markdown(paper.parts)
    assert text.index("more with PoLMDP, chi2(1)") < text.index("|")
    assert "by ranks shorter with PoLMDP, U = 177976" in text
    assert "by ranks higher with PoLMDP, U = 231203" in text


def test_no_difference_is_said_to_be_none_shown(tmp_path):
    rows = [trial_row("P1", 1, "polmdp"), trial_row("P2", 1, "optimal")]
    text = markdown(analyse_path(write_table(TRIALS, rows, tmp_path)[0]).parts)
    assert text.count("no difference shown at alpha = .05") == 3


def test_the_fine_print_says_what_overstates_certainty(paper):
    text = markdown(paper.parts)
    assert "treat trials as independent. That is the paper's choice" in text
    assert "overstate certainty" in text


def test_the_fine_print_says_that_lead_in_makes_times_incomparable(paper):
    text = markdown(paper.parts)
    assert "about 5 s of lead-in" in text
    assert "15.67 s and 18.22 s cannot be compared" in text


def test_a_single_table_has_no_demographics_and_says_so(paper):
    assert "no demographics" in plain_text(paper.parts)


def test_an_export_folder_has_demographics(export):
    text = markdown(analyse_path(export).parts)
    assert "| gender: woman | 3 (100.0 %) | 3 (100.0 %) | 6 (100.0 %) |" in text
    assert "| age, years: mean (SD), range, n | 30.0 (0.0), 30-30, n = 3 |" in text


def test_terminal_text_is_plain_and_narrow(paper):
    text = plain_text(paper.parts)
    assert text.isascii()
    assert max(len(line) for line in text.splitlines()) <= 100


def test_the_report_links_figures_that_exist(written):
    links = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", (written / "report.md").read_text())
    assert len(links) == 3
    for link in links:
        assert (written / link).read_text().startswith("<?xml")
        assert (written / link).with_suffix(".png").read_bytes().startswith(b"\x89PNG")


def test_report_json_holds_every_estimate_at_full_precision(written, paper):
    report = json.loads((written / "report.json").read_text())
    block = report["as_in_paper"]
    assert report["schema_version"] == 1
    assert block["correct"]["test"]["statistic"] == paper.block.correct.test.statistic
    assert block["prediction_time"]["arms"]["polmdp"]["mean"] == 15.670102040816328
    assert block["confidence"]["test"]["u_treatment"] == 278397
    assert block["trials_treated_as_independent"] is True


def test_report_json_gives_n_used_and_n_missing_with_every_estimate(written):
    block = json.loads((written / "report.json").read_text())["as_in_paper"]
    for measure in ("correct", "prediction_time", "confidence"):
        assert "n_missing" in block[measure]["test"]
        for arm in block[measure]["arms"].values():
            assert {"n", "n_missing"} <= arm.keys()


def test_report_json_names_its_input_and_its_software(written, paper_fixture):
    report = json.loads((written / "report.json").read_text())
    digest = hashlib.sha256(paper_fixture.read_bytes()).hexdigest()
    assert report["inputs"] == [{"file": "paper_fixture.csv", "sha256": digest, "rows": 1500}]
    assert {"python", "goalguess", "scipy", "polars", "numpy"} <= report["packages"].keys()


def test_the_same_data_give_the_same_bytes(written, paper, tmp_path):
    write_report(paper, tmp_path / "again", silent)
    files = sorted(path.relative_to(written) for path in written.rglob("*.*"))
    assert len(files) == 8
    for file in files:
        assert (tmp_path / "again" / file).read_bytes() == (written / file).read_bytes(), file


def test_a_second_report_replaces_the_first_and_spares_other_files(export, tmp_path):
    results = analyse_path(export)
    folder = tmp_path / "report"
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    (folder / "report.json").write_text("old")
    write_report(results, folder, silent)
    assert (folder / "notes.txt").read_text() == "mine"
    assert json.loads((folder / "report.json").read_text())["schema_version"] == 1


def test_a_report_that_fails_half_way_leaves_nothing(export, tmp_path):
    def interrupted(_what):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_report(analyse_path(export), tmp_path / "reports" / "one", interrupted)
    assert not list((tmp_path / "reports").iterdir())


def test_a_file_in_the_way_of_the_report_is_one_clear_error(export, tmp_path):
    (tmp_path / "taken").write_text("mine")
    with pytest.raises(AnalysisError, match="expected a folder to write to"):
        write_report(analyse_path(export), tmp_path / "taken", silent)
    assert (tmp_path / "taken").read_text() == "mine"


def test_simulated_trials_in_the_numbers_are_the_first_thing_to_note(tmp_path):
    rows = [*six_participants(), trial_row("bot", 1, "polmdp", simulated=True)]
    path = write_table(TRIALS, rows, tmp_path)[0]
    assert codes(path)[0] == "simulated_left_out"
    assert codes(path, with_simulated=True)[0] == "simulated_included"
    text = plain_text(analyse_path(path, with_simulated=True).parts)
    assert "Not a result: 1 simulated and 0 preview trials are in the numbers" in text


def test_incomplete_participants_are_noted(tmp_path):
    path = write_table(TRIALS, six_participants()[:-1], tmp_path)[0]
    assert "incomplete_participants" in codes(path)


def test_tests_that_are_not_defined_are_noted(tmp_path):
    rows = [trial_row("P1", 1, "polmdp"), trial_row("P2", 1, "optimal")]
    found = codes(write_table(TRIALS, rows, tmp_path)[0])
    assert {"degenerate_margin", "constant_outcome", "too_few_values"} <= set(found)


def test_trials_of_two_studies_are_not_pooled_in_silence(tmp_path):
    rows = six_participants()
    assert "several_studies" not in codes(write_table(TRIALS, rows, tmp_path)[0])
    rows[-1]["study_hash"] = "another"
    assert "several_studies" in codes(write_table(TRIALS, rows, tmp_path)[0])


def test_small_expected_counts_are_noted(export):
    assert "small_expected_count" in codes(export)


def test_missing_answers_are_noted_and_counted(tmp_path):
    rows = [
        {name: row[name] for name in ("participant", "condition", "scenario", "trial_index")}
        | {name: row[name] for name in ("correct", "stop_time_s", "length_s", "confidence")}
        for row in six_participants()
    ]
    rows[0]["confidence"] = None
    rows[1]["correct"] = None
    results = analyse_path(as_csv(tmp_path / "t.csv", rows))
    texts = [notice.text for notice in results.notices if notice.code == "missing_values"]
    assert len(texts) == 3
    block = report_json(results)["as_in_paper"]
    assert block["confidence"]["arms"]["polmdp"]["n_missing"] == 1
    assert block["correct"]["test"]["n"] == 17


def test_a_complete_export_gives_no_notice_about_its_layout(export):
    assert not {"columns_renamed", "no_participants_table"} & set(codes(export))


def test_participants_texts_cannot_break_the_table(tmp_path):
    rows = six_participants()
    people = participants_of(rows)
    people[0] |= {"occupation": "a | b\n<script>"}
    write_table(TRIALS, rows, tmp_path)
    write_table(PARTICIPANTS, people, tmp_path)
    text = markdown(analyse_path(tmp_path).parts)
    assert r"| occupation: a \| b &lt;script> | 1 (33.3 %) | 0 (0.0 %) | 1 (16.7 %) |" in text


def test_each_part_has_its_markdown():
    parts: list[Part] = [
        Heading("Title", 1),
        Paragraph("Text."),
        Items(("one", "two")),
        Grid(("", "n"), (("a", "1"),)),
        Picture("f.svg", "a figure"),
    ]
    assert markdown(parts) == (
        "# Title\n\nText.\n\n- one\n- two\n\n|  | n |\n| --- | ---: |\n| a | 1 |\n\n"
        "![a figure](f.svg)\n"
    )


def test_terminal_tables_are_aligned_and_pictures_left_out():
    parts: list[Part] = [
        Grid(("", "n"), (("arm", "1000"), ("a", "1"))),
        Picture("f.svg", "a figure"),
    ]
    assert plain_text(parts) == "        n\narm  1000\na       1\n"


def test_wrapping_never_parts_a_symbol_from_its_number():
    text = plain_text([Items((("word " * 15) + "U = 177976, p < .001",))])
    assert "U = 177976" in text
    assert "p < .001" in text
    assert len(text.splitlines()) > 1
