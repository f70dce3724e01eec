"""With and without each rule: the numbers that a plan with these rules gives, and no others."""

import pytest

from analysis import PARTICIPANTS, TRIALS, analyse_path, read_plan, write_table
from analysis.exclusions import RULES
from analysis.study import NEEDED
from tests.analysis.rows import as_csv, participants_of, six_participants

PLANNED = """
trials_per_participant = 3
[[exclusions]]
rule = "too_fast_trials"
at_least = 2
[[exclusions]]
rule = "failed_control_question"
tries_above = 1
"""
NO_RULES, HASTY, FAILED = PLANNED.split("[[exclusions]]\n")


def plan_text(*rules: str) -> str:
    return "[[exclusions]]\n".join([NO_RULES, *rules])


@pytest.fixture
def study(tmp_path):
    """Twelve people: two hasty ones (one of whom failed, too), one who failed, one who paused."""
    rows = six_participants()
    rows += [row | {"participant": f"Q{row['participant'][1]}", "confidence": 4} for row in rows]
    for row in rows:
        if row["participant"] in ("P2", "P5"):
            row |= {"first_decision_s": 20.0, "too_fast": True}
        if row["participant"] == "Q1":
            row["paused_s"] = 20.5
    people = participants_of(rows)
    for person in people:
        if person["participant"] in ("P5", "Q4"):
            person["control_tries"] = 2
    write_table(TRIALS, rows, tmp_path / "export")
    write_table(PARTICIPANTS, people, tmp_path / "export")

    def analysed(text):
        path = tmp_path / "mine.toml"
        path.write_text(text)
        return analyse_path(tmp_path / "export", read_plan(path)).evidence

    return analysed


def named(evidence, change, rule=None):
    (found,) = (
        each
        for each in evidence.exclusions
        if each.change == change and (rule is None or each.exclusion.rule == rule)
    )
    return found


@pytest.mark.parametrize(
    ("change", "rule", "rules", "left_out"),
    [
        ("as_planned", None, (HASTY, FAILED), 3),
        ("without_rule", "too_fast_trials", (FAILED,), 2),
        ("without_rule", "failed_control_question", (HASTY,), 2),
        ("with_rule", "long_pauses", (HASTY, FAILED, 'rule = "long_pauses"\nabove_s = 60\n'), 4),
        ("no_rule", None, (), 0),
    ],
)
def test_a_row_is_exactly_what_a_plan_with_its_rules_gives(study, change, rule, rules, left_out):
    row = named(study(plan_text(HASTY, FAILED)), change, rule)
    conclusions = study(plan_text(*rules)).conclusions
    assert row.left_out == left_out
    assert row.selection.tests == {each.measure: each.primary for each in conclusions}


def test_every_rule_has_its_row_and_without_rules_no_row_comes_twice(study):
    planned = [(each.change, each.exclusion) for each in study(PLANNED).exclusions]
    assert {each.rule for _, each in planned if each} == set(RULES)
    assert len(planned) == len(set(map(str, planned))) == len(RULES) + 2
    changes = [each.change for each in study(NO_RULES).exclusions]
    assert changes == ["as_planned", *["with_rule"] * len(RULES)]


def test_rules_that_are_tried_have_the_parameters_that_a_plan_would_give():
    for name, rule in RULES.items():
        usual = rule.usual(10)
        assert {key: type(value) for key, value in usual.items()} == dict(rule.parameters), name
    assert RULES["incomplete"].usual(7) == {"fewer_than": 7}


def test_lists_that_nobody_has_whole_are_complete_when_as_long_as_the_longest(export):
    """All six have three trials of the default plan's ten."""
    row = named(analyse_path(export).evidence, "with_rule", "incomplete")
    assert (row.exclusion.parameters, row.left_out) == ({"fewer_than": 3}, 0)


def test_a_rule_whose_column_is_missing_or_empty_says_so(tmp_path):
    kept = (*NEEDED, "correct")
    rows = [{name: row[name] for name in kept} | {"guess": None} for row in six_participants()]
    evidence = analyse_path(as_csv(tmp_path / "t.csv", rows)).evidence
    for rule, reason in {
        "same_guess": "the column guess in the table trials is empty",
        "long_pauses": "there is no column paused_s in the table trials",
        "impossible_time": "there is no column impossible_time in the table participants",
    }.items():
        row = named(evidence, "with_rule", rule)
        assert (row.cannot, row.selection, row.left_out) == (reason, None, None)


def test_a_column_that_an_older_export_lacks_is_missing_not_empty(export):
    path = export / "participants.csv"
    for other in export.glob("participants.*"):
        if other.suffix != ".csv":
            other.unlink()
    lines = [line.split(",") for line in path.read_text().splitlines()]
    at = lines[0].index("impossible_time")
    path.write_text("\n".join(",".join(cells[:at] + cells[at + 1 :]) for cells in lines) + "\n")
    row = named(analyse_path(export).evidence, "with_rule", "impossible_time")
    assert row.cannot == "there is no column impossible_time in the table participants"


def test_what_the_other_rows_leave_out_leaks_into_no_other_result(study, monkeypatch):
    evidence = study(PLANNED)
    monkeypatch.setattr("analysis.evidence.MOST_TRIALS", 0)
    alone = study(PLANNED)
    assert (alone.exclusions, alone.devices) == (None, None)
    assert alone.conclusions == evidence.conclusions
    assert alone.sensitivity == evidence.sensitivity


def test_an_arm_that_a_rule_empties_has_no_test(export):
    """All guess B throughout with polmdp, and never elsewhere."""
    row = named(analyse_path(export).evidence, "with_rule", "same_guess")
    assert row.left_out == 3
    assert set(row.selection.tests.values()) == {None}


def test_a_rule_may_stand_twice_in_a_plan(study):
    evidence = study(plan_text(HASTY, HASTY))
    twice = [each for each in evidence.exclusions if each.change == "without_rule"]
    assert [each.left_out for each in twice] == [2, 2]
