"""Exclusions: each rule takes whom it says, once, and only when the plan names it."""

import pytest

from analysis import (
    PARTICIPANTS,
    TRIALS,
    EmptyArmError,
    TomlError,
    default_plan,
    read_dataset,
    read_plan,
    write_table,
)
from analysis.exclusions import RULES
from tests.analysis.rows import as_csv, participants_of, six_participants

KEPT = (
    "participant",
    "condition",
    "scenario",
    "trial_index",
    "correct",
    "stop_time_s",
    "length_s",
    "confidence",
)
RULE = '[[exclusions]]\nrule = "{}"\n'


@pytest.fixture
def taken_by(tmp_path):
    """Read six participants, changed by `change`, under a plan; return whom each rule took."""

    def read(plan_text, change, *, changed_people=lambda _people: None):
        rows = six_participants()
        change(rows)
        people = participants_of(rows)
        changed_people(people)
        write_table(TRIALS, rows, tmp_path)
        write_table(PARTICIPANTS, people, tmp_path)
        (tmp_path / "mine.toml").write_text(plan_text)
        return read_dataset(tmp_path, read_plan(tmp_path / "mine.toml"))

    return read


def trials_of(rows, participant):
    return [row for row in rows if row["participant"] == participant]


def names(data):
    return [each.participants for each in data.excluded]


def rarely_answered(rows):
    rows.remove(trials_of(rows, "P2")[-1])


def hasty(rows):
    for row in trials_of(rows, "P2")[:2]:
        row |= {"first_decision_s": 20.0, "too_fast": True}
    trials_of(rows, "P3")[0].update({"first_decision_s": 20.0, "too_fast": True})


def only_p2_repeats_a_guess(rows):
    for row in rows:
        if row["participant"] != "P2" and row["trial_index"] == 1:
            row |= {"guess": "C", "correct": False, "score": 0.0, "prediction_time_s": 20.0}
    for row in trials_of(rows, "P3")[1:]:
        rows.remove(row)


def motionless(rows):
    for row in trials_of(rows, "P2"):
        row["pointer_moved"] = False
    trials_of(rows, "P3")[0]["pointer_moved"] = False
    for row, moved in zip(trials_of(rows, "P4"), (False, None, False), strict=True):
        row["pointer_moved"] = moved


def interrupted(rows):
    for row in trials_of(rows, "P2"):
        row["paused_s"] = 20.5
    for row in trials_of(rows, "P3"):
        row["paused_s"] = 20.0


def seen_twice(rows):
    trials_of(rows, "P2")[2]["scenario"] = "S01"


CASES = {
    "incomplete": ("fewer_than = 3", rarely_answered),
    "too_fast_trials": ("at_least = 2", hasty),
    "same_guess": ("", only_p2_repeats_a_guess),
    "never_moved_pointer": ("", motionless),
    "long_pauses": ("above_s = 60", interrupted),
    "duplicate_stimuli": ("", seen_twice),
}


@pytest.mark.parametrize("rule", CASES)
def test_a_rule_takes_whom_it_names_and_nobody_near(taken_by, rule):
    parameters, change = CASES[rule]
    data = taken_by(RULE.format(rule) + parameters, change)
    assert names(data) == [("P2",)]
    assert data.trials["participant"].unique().sort().to_list() == ["P1", "P3", "P4", "P5", "P6"]
    assert data.participants is not None
    assert "P2" not in data.participants["participant"]


def test_who_needed_too_many_tries_for_the_control_question_is_taken(taken_by):
    def failed_once(people):
        people[1]["control_tries"] = 2

    data = taken_by(
        RULE.format("failed_control_question") + "tries_above = 1",
        lambda _rows: None,
        changed_people=failed_once,
    )
    assert names(data) == [("P2",)]


def test_who_sent_times_that_cannot_be_is_taken_and_who_cannot_be_judged_is_not(taken_by):
    def judged(people):
        people[1]["impossible_time"] = True
        people[2]["impossible_time"] = None

    data = taken_by(RULE.format("impossible_time"), lambda _rows: None, changed_people=judged)
    assert names(data) == [("P2",)]
    assert data.excluded[0].exclusion.reason == "sent times that cannot be"


def test_every_rule_has_a_case():
    assert {*CASES, "failed_control_question", "impossible_time"} == set(RULES)


def test_without_a_rule_in_the_plan_nobody_is_taken(taken_by):
    def everything(rows):
        hasty(rows)
        motionless(rows)
        rows[0]["impossible_time"] = True

    assert default_plan().exclusions == ()
    data = taken_by("", everything)
    assert (data.excluded, len(data.trials)) == ((), 18)


def test_who_breaks_two_rules_counts_for_the_first(taken_by):
    def both(rows):
        hasty(rows)
        motionless(rows)
        for row in trials_of(rows, "P5"):
            row["pointer_moved"] = False

    data = taken_by(
        RULE.format("never_moved_pointer") + RULE.format("too_fast_trials") + "at_least = 1", both
    )
    assert names(data) == [("P2", "P5"), ("P3",)]


def test_the_reason_tells_the_parameter(taken_by):
    data = taken_by(RULE.format("long_pauses") + "above_s = 60", interrupted)
    assert data.excluded[0].exclusion.reason == "paused for more than 60 s in all"


def test_missing_guesses_are_not_the_same_guess(tmp_path):
    rows = [{name: row[name] for name in KEPT} for row in six_participants()]
    for row in rows:
        row["guess"] = None if row["participant"] == "P2" else "ABC"[row["trial_index"] - 1]
    (tmp_path / "mine.toml").write_text(RULE.format("same_guess"))
    data = read_dataset(as_csv(tmp_path / "t.csv", rows), read_plan(tmp_path / "mine.toml"))
    assert names(data) == [()]


def test_an_arm_that_exclusions_empty_is_one_clear_error(taken_by):
    with pytest.raises(EmptyArmError, match=r"polmdp: .* \(6 participants excluded by the plan\)"):
        taken_by(RULE.format("incomplete") + "fewer_than = 4", lambda _rows: None)


@pytest.mark.parametrize(
    ("rule", "missing"),
    [
        ("never_moved_pointer", "the column pointer_moved in the table trials"),
        ("failed_control_question", "the column control_tries in the table participants"),
        ("impossible_time", "the column impossible_time in the table participants"),
    ],
)
def test_a_rule_without_its_column_is_named_by_its_place_in_the_plan(tmp_path, rule, missing):
    rows = [{name: row[name] for name in KEPT} for row in six_participants()]
    parameters = "tries_above = 1" if rule == "failed_control_question" else ""
    (tmp_path / "mine.toml").write_text(RULE.format("same_guess") + RULE.format(rule) + parameters)
    rows = [row | {"guess": "A"} for row in rows]
    with pytest.raises(TomlError) as caught:
        read_dataset(as_csv(tmp_path / "t.csv", rows), read_plan(tmp_path / "mine.toml"))
    assert (caught.value.file, caught.value.key) == ("mine.toml", "exclusions[2].rule")
    assert missing in str(caught.value)
