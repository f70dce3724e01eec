"""What the report says: the answer first, then all the rest, with what is to be minded."""

import re

import polars as pl
import pytest

from analysis import PARTICIPANTS, TRIALS, analyse_path, write_table
from analysis.reporting.apa import apa_sentences
from analysis.reporting.document import Finding, Heading, Picture
from analysis.reporting.markdown import markdown
from analysis.reporting.plain import plain_text
from analysis.reporting.report import brief_parts, report_parts
from tests.analysis.rows import participants_of, six_participants, trial_row


def codes(path, **options):
    return [notice.code for notice in analyse_path(path, **options).notices]


def one_trial_an_arm(tmp_path):
    rows = [trial_row("P1", 1, "polmdp"), trial_row("P2", 1, "optimal")]
    return write_table(TRIALS, rows, tmp_path)[0]


@pytest.mark.parametrize("said_by", ["whole report", "terminal"])
def test_it_says_the_papers_numbers(paper, said_by):
    whole = said_by == "whole report"
    text = markdown(report_parts(paper)) if whole else plain_text(brief_parts(paper))
    for said in (
        "chi2(1) = 48.864, p < .001",
        "U = 177976, p < .001",
        "U = 231203, p = .001",
        "15.67 s with PoLMDP, 18.22 s with optimal",
        "6.08 with PoLMDP, 5.78 with optimal",
        "84.9 % with PoLMDP, 69.6 % with optimal",
        "treat trials as independent. That is the paper's choice",
    ):
        assert said in " ".join(text.split())


def test_it_begins_with_the_answers_to_the_hypotheses(paper):
    parts = report_parts(paper)
    verdicts = [part.verdict for part in parts[1:4] if isinstance(part, Finding)]
    assert verdicts == [
        "H1, correct guesses: more with PoLMDP.",
        "H2, time of prediction: shorter with PoLMDP.",
        "H2, confidence: no difference shown at alpha = .05.",
    ]


def test_an_answer_has_shares_effect_interval_test_and_the_model_beside_it(paper):
    answer = report_parts(paper)[1]
    assert isinstance(answer, Finding)
    assert answer.text == (
        "84.9 % correct with PoLMDP, 69.6 % with optimal. Difference 15.3 percentage points, "
        "95 % interval 9.5 to 21.1; t(36) = 5.32, p < .001, Holm-corrected p < .001. The mixed "
        "model agrees: odds ratio = 2.70, 95 % interval 1.86 to 3.93, t(36) = 5.39, p < .001, "
        "Holm-corrected p < .001."
    )


def test_what_is_tested_speaks_of_other_people_and_scenarios(paper):
    assert "they speak of other people and other scenarios too" in markdown(report_parts(paper))


def test_what_no_scenario_was_shared_in_does_not_speak_of_other_scenarios(tmp_path):
    rows = six_participants()
    for row in rows:
        row["scenario"] += row["condition"]
    text = markdown(report_parts(analyse_path(write_table(TRIALS, rows, tmp_path)[0])))
    assert "t(4) = " in text.partition("## Please note")[0]
    assert "Every scenario was seen in one arm only" in text
    assert "ome scenarios were seen" not in text
    assert "other scenarios too" not in text


def test_what_the_papers_tests_show_and_the_two_way_tests_do_not_is_told_apart(paper):
    """Golden paper_confidence_counts: R 4.2.2 wilcox.test, p = .001 on trials."""
    text = markdown(report_parts(paper))
    assert "by ranks higher with PoLMDP, U = 231203, p = .001" in text
    assert "t(36) = 1.74, p = .091" in text


def test_the_order_is_answer_figures_tables_fine_print(paper):
    parts = report_parts(paper, {"Correct guesses": [Picture("f", "a caption", "a figure")]})
    headings = [part.text for part in parts if isinstance(part, Heading) and part.level == 2]
    assert headings == [
        "Please note",
        "Figures",
        "Who took part",
        "All methods",
        "As in the paper",
        "Sentences for a manuscript",
        "Fine print",
    ]


def test_the_rate_of_correct_stops_is_told_by_either_clustering(paper):
    text = markdown(report_parts(paper))
    assert "95 % CI [1.47, 2.00], t(36) = 7.02, p < .001 (Cox regression, clustered by" in text
    for row in (
        "| Cox regression, clustered by participant and scenario | hazard ratio 1.71 | 1.47 to ",
        "| Cox regression, clustered by participant | hazard ratio 1.71 | 1.48 to 1.98 | z = ",
        "- Rate of correct stops: Cox regression of the time to a correct stop, wrong stops "
        "censored, Efron ties, variance two-way clustered by participant and scenario. Source: ",
    ):
        assert row in text


def test_a_sentence_on_stops_speaks_of_scenarios_where_they_can_be_told(paper, tmp_path):
    (sentence,) = (each for each in apa_sentences(paper) if each.startswith("Rate of"))
    assert sentence.endswith("censored, clustered by participant and scenario).")
    rows = [row | {"scenario": "S1"} for row in six_participants()]
    of_one = analyse_path(write_table(TRIALS, rows, tmp_path)[0])
    (sentence,) = (each for each in apa_sentences(of_one) if each.startswith("Rate of"))
    assert " z = " in sentence
    assert sentence.endswith("censored, clustered by participant).")


def test_what_cannot_be_tested_is_said_so(tmp_path):
    results = analyse_path(one_trial_an_arm(tmp_path))
    answers = [part for part in report_parts(results) if isinstance(part, Finding)]
    for answer in answers:
        assert answer.verdict.endswith("not to be tested with these data.")
        assert "An arm has a single participant" in answer.text
        assert "p = NA" not in answer.text
    assert "other scenarios too" not in markdown(report_parts(results))
    assert markdown(report_parts(results)).count("no difference shown at alpha = .05") == 3


def test_arms_too_few_and_unequal_for_the_tests_level_are_told_in_every_answer(
    paper_fixture, tmp_path
):
    trials = pl.read_csv(paper_fixture)
    people = trials.select("participant", "condition").unique(maintain_order=True)
    kept = people.group_by("condition", maintain_order=True).map_groups(
        lambda arm: arm.head(4 if arm["condition"][0] == "polmdp" else 12)
    )
    trials.join(kept, on="participant", how="semi").write_csv(tmp_path / "few.csv")
    parts = report_parts(analyse_path(tmp_path / "few.csv"))
    answers = [part.text for part in parts if isinstance(part, Finding)]
    assert len(answers) == 3
    for answer in answers:
        assert "finds a difference where there is none in more than 6 % of studies." in answer
        assert "interval and p are rough" not in answer


def test_an_interval_wider_than_possible_is_said_to_be_in_the_answer_and_in_the_table(
    paper_fixture, tmp_path
):
    few = pl.read_csv(paper_fixture).filter(pl.col("video").is_in(["V01", "V02", "V03"]))
    few.write_csv(tmp_path / "few.csv")
    results = analyse_path(tmp_path / "few.csv")
    parts = report_parts(results)
    outside = "he interval reaches outside 0 to 1, where every AUC lies, and is not cut."
    _, time, _ = (part for part in parts if isinstance(part, Finding))
    assert "AUC = .279, 95 % interval -.042 to .600" in time.text
    assert f"T{outside}" in time.text
    text = markdown(parts)
    assert f"- AUC, clustered by participant and scenario (primary): t{outside}" in text
    assert "- PoLMDP: the interval reaches outside 0 to 100 %, where every share lies" in text


def test_no_number_is_printed_as_nan_or_none(paper, tmp_path):
    for results in (paper, analyse_path(one_trial_an_arm(tmp_path))):
        text = markdown(report_parts(results))
        assert not re.search(r"\b(nan|inf|None)\b", text)
        assert ".000," not in text


def test_a_verdict_of_the_paper_stands_beside_where_it_tips(paper):
    """Golden tipping_icc: scipy chi2.ppf; 48.864 and 10 trials hold at any correlation.

    Correlations: F by statsmodels, of values and of scipy's ranks, between quantiles by scipy.
    """
    text = markdown(report_parts(paper))
    assert (
        "| correct guesses | .051 | .022 to .089 | 1.46 | 12.72 | stays significant at any |"
        in text
    )
    assert "| confidence | .260 | .206 to .325 | 3.34 | 2.68 | .186 |" in text


def test_every_method_run_has_its_source_in_the_fine_print(paper):
    text = markdown(report_parts(paper)).partition("## Fine print")[2]
    for compared in paper.evidence.comparisons.values():
        for result in compared.results.values():
            assert f"{result.method}. Source: {result.source}." in text


def test_the_plan_is_printed_with_its_hash(paper):
    text = markdown(report_parts(paper))
    assert f"default plan, SHA-256 of what it says: {paper.data.plan.sha256}" in text
    assert "- alpha: 0.05\n" in text
    assert "- exclusions: none\n" in text


def test_sentences_for_a_manuscript_are_whole_sentences(paper):
    sentences = apa_sentences(paper)
    assert len(sentences) == 10
    for sentence in sentences:
        assert sentence.endswith(".")
    assert (
        "Confidence: mean 6.08 with PoLMDP, 5.78 with optimal, AUC = .546, 95 % CI [.492, .600], "
        "t(36) = 1.74, p = .091, Holm-corrected p = .091 (PoLMDP against optimal; trials "
        "clustered by participant and scenario). An AUC of .45 or less, or of .55 or more, cannot "
        "be excluded (two one-sided tests at alpha = .05, of this measure alone: p = .445; 90 % "
        "interval .501 to .591)."
    ) in sentences


def test_a_manuscript_has_no_p_of_equal_values(tmp_path):
    rows = [row | {"confidence": 5} for row in six_participants()]
    results = analyse_path(write_table(TRIALS, rows, tmp_path)[0])
    confidence = apa_sentences(results)[2]
    assert "AUC = .500, not to be tested with these data (PoLMDP" in confidence


def test_terminal_text_is_plain_and_narrow(paper):
    text = plain_text(brief_parts(paper))
    assert text.isascii()
    assert max(len(line) for line in text.splitlines()) <= 100


def test_an_exports_times_count_motion_only_and_so_cannot_be_compared_with_the_papers(export):
    text = markdown(report_parts(analyse_path(export)))
    assert "about 5 s of lead-in" in text
    assert "15.67 s and 18.22 s cannot be compared" in text
    assert "else the full length; both count motion only." in text
    assert "as the table gives them" not in text


def test_of_a_table_from_elsewhere_nothing_is_said_to_be_known_of_its_lead_in(paper):
    text = markdown(report_parts(paper))
    assert "about 5 s of lead-in" in text
    assert "motion only" not in text
    as_given = "are as the table gives them; whether a lead-in is counted in is not known"
    assert f"Times {as_given}" in text
    assert f"else the full length; both {as_given}." in text


def test_a_single_table_has_no_demographics_and_says_so(paper):
    assert "no demographics" in plain_text(report_parts(paper))


def test_an_export_folder_has_demographics(export):
    text = markdown(report_parts(analyse_path(export)))
    assert "| gender: woman | 3 (100.0 %) | 3 (100.0 %) | 6 (100.0 %) |" in text
    assert "| age, years: mean (SD) | 30.0 (0.0) | 30.0 (0.0) | 30.0 (0.0) |" in text
    assert "| age told by | 3 | 3 | 6 |" in text


def test_answers_keep_their_capital_i(tmp_path):
    rows = six_participants()
    write_table(TRIALS, rows, tmp_path)
    people = [
        person | {"robot_familiarity": "i have seen some", "occupation": "painting"}
        for person in participants_of(rows)
    ]
    write_table(PARTICIPANTS, people, tmp_path)
    text = markdown(report_parts(analyse_path(tmp_path)))
    assert "| robot familiarity: I have seen some | 3 " in text
    assert "| occupation: painting | 3 " in text


def test_simulated_trials_in_the_numbers_are_the_first_thing_to_note(tmp_path):
    rows = [*six_participants(), trial_row("bot", 1, "polmdp", simulated=True)]
    path = write_table(TRIALS, rows, tmp_path)[0]
    assert codes(path)[0] == "simulated_left_out"
    assert codes(path, with_simulated=True)[0] == "simulated_included"
    results = analyse_path(path, with_simulated=True)
    not_a_result = "Not a result: 1 simulated and 0 preview trials are in the numbers"
    assert not_a_result in plain_text(report_parts(results))
    assert apa_sentences(results)[0].startswith(not_a_result)
    assert apa_sentences(analyse_path(path))[0].startswith("Correct guesses:")


def test_times_that_cannot_be_are_told_before_the_sentences_for_a_manuscript(tmp_path):
    rows = six_participants()
    rows[0]["impossible_time"] = True
    results = analyse_path(write_table(TRIALS, rows, tmp_path)[0])
    assert apa_sentences(results)[0].startswith("Times that cannot be: 1 of the participants")


def test_the_synthetic_trials_are_said_to_be_no_result_before_all_else_to_note(paper):
    noted = markdown(report_parts(paper)).partition("## Please note\n\n")[2]
    said = "Not a result: synthetic data, made to print the paper's numbers."
    assert noted.startswith(f"- {said}\n")
    assert said in " ".join(plain_text(brief_parts(paper)).split())
    assert apa_sentences(paper)[0] == said


def test_other_trials_are_not_said_to_be_synthetic(paper_fixture, tmp_path):
    lines = paper_fixture.read_text().splitlines()
    (tmp_path / paper_fixture.name).write_text("\n".join(lines[:-1]) + "\n")
    assert "synthetic_data" not in codes(tmp_path / paper_fixture.name)


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


def test_a_complete_export_gives_no_notice_about_its_layout(export):
    assert not {"columns_renamed", "no_participants_table"} & set(codes(export))


def test_participants_texts_cannot_break_the_table(tmp_path):
    rows = six_participants()
    people = participants_of(rows)
    people[0] |= {"occupation": "a | b\n<script>"}
    write_table(TRIALS, rows, tmp_path)
    write_table(PARTICIPANTS, people, tmp_path)
    text = markdown(report_parts(analyse_path(tmp_path)))
    assert r"| occupation: a \| b &lt;script> | 1 (33.3 %) | 0 (0.0 %) | 1 (16.7 %) |" in text
