"""The tables by exclusion rule and by device: what they show, and what they lack and why."""

from analysis import PARTICIPANTS, TRIALS, analyse_path, read_plan, write_table
from analysis.reporting.document import Heading
from analysis.reporting.html import html
from analysis.reporting.markdown import markdown
from analysis.reporting.selection_tables import device_parts, exclusion_parts
from tests.analysis.rows import participants_of, six_participants


def exclusions_of(results):
    evidence = results.evidence
    return exclusion_parts(evidence.exclusions, evidence.conclusions, results.data.plan)


def devices_of(results):
    evidence = results.evidence
    return device_parts(evidence.devices, evidence.conclusions, results.data.plan)


def test_each_row_says_what_was_left_out_and_what_is_left(paper):
    told = markdown(exclusions_of(paper))
    assert (
        "|  | participants left out | trials | correct guesses, percentage points "
        "| time of prediction, AUC | confidence, AUC |"
    ) in told
    row = "| 0 | 1,500 | 15.3 (9.5 to 21.1), p < .001 | .349 (.310 to .388), p < .001 |"
    assert f"| as planned: no exclusions {row}" in told
    assert f"| with incomplete: answered fewer than 10 trials {row}" in told


def test_rules_that_cannot_be_applied_say_why_below_the_table(paper):
    assert (
        "- With long_pauses: paused for more than 60 s in all: cannot be applied, there is no "
        "column paused_s in the table trials."
    ) in markdown(exclusions_of(paper))


def test_the_plans_rules_are_taken_away_one_by_one(export, tmp_path):
    (tmp_path / "mine.toml").write_text('[[exclusions]]\nrule = "never_moved_pointer"\n')
    told = markdown(exclusions_of(analyse_path(export, read_plan(tmp_path / "mine.toml"))))
    for name in (
        "all rules as planned",
        "without never_moved_pointer: never moved the pointer",
        "no exclusions",
    ):
        assert f"| {name} | 0 | 18 |" in told
    assert "with never_moved_pointer" not in told


def test_lines_of_a_cell_are_apart_in_html_alone(paper):
    page = html([Heading("Title", 1), *exclusions_of(paper)], {})
    assert '<td>15.3\n(9.5 to 21.1),\n<span class="whole">p &lt; .001</span></td>' in page
    assert "tbody td { white-space: pre; }" in page


def test_devices_are_said_to_describe_and_to_test_nothing(export):
    told = markdown(devices_of(analyse_path(export)))
    assert "These numbers describe; nothing here tests whether devices differ." in told
    assert "|  | n, PoLMDP | n, optimal | correct guesses, percentage points |" in told
    assert "| pointer: mouse | 3 | 3 | 33.3" in told


def test_groups_without_a_test_say_why(tmp_path):
    """P1 to P3 see polmdp; P3 and P4 alone used touch, P1 alone a keyboard."""
    rows = six_participants()
    people = participants_of(rows)
    for person, pointer in zip(people, ("keyboard", "mouse", "touch", "touch"), strict=False):
        person["pointer_type"] = pointer
    write_table(TRIALS, rows, tmp_path)
    write_table(PARTICIPANTS, people, tmp_path)
    told = markdown(devices_of(analyse_path(tmp_path)))
    assert f"| pointer: keyboard | 1 | 0{3 * ' | an arm has none'} |" in told
    assert "| pointer: touch | 1 | 1 | 33.3 (no interval) |" in told
    assert (
        "- An arm has a single participant, which does not tell how participants differ "
        "(pointer: mouse; pointer: touch)."
    ) in told


def test_what_is_said_of_the_whole_study_is_not_said_again_of_each_row(export):
    results = analyse_path(export)
    assert any(each.text.startswith("Few clusters") for each in results.notices)
    assert "ewer than 10 participants" not in markdown(devices_of(results))


def test_a_table_without_devices_says_of_each_trait_why(paper):
    told = markdown(devices_of(paper))
    assert "| " not in told
    assert "- Pointer: left out, there is no table participants." in told


def test_above_the_stated_size_both_are_left_out_with_their_reason(export, monkeypatch):
    monkeypatch.setattr("analysis.evidence.MOST_TRIALS", 17)
    results = analyse_path(export)
    for parts in (exclusions_of(results), devices_of(results)):
        assert "Left out, since it takes too long above 100,000 trials." in markdown(parts)
    monkeypatch.setattr("analysis.evidence.MOST_TRIALS", 18)
    assert analyse_path(export).evidence.exclusions is not None
