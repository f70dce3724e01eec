"""What is told of the data: who was left out, what was pooled, where the design was not kept."""

import pytest

from analysis import TRIALS, TableMapping, read_dataset, read_plan, write_table
from analysis.data_notices import data_notices
from tests.analysis.rows import as_csv, six_participants, trial_row


@pytest.fixture
def told(tmp_path):
    """Write trials and return the notices about them, as a mapping from code to text."""

    def read(rows, plan_text=None):
        path = write_table(TRIALS, rows, tmp_path)[0]
        plan = None
        if plan_text is not None:
            (tmp_path / "mine.toml").write_text(plan_text)
            plan = read_plan(tmp_path / "mine.toml")
        return {each.code: each.text for each in data_notices(read_dataset(path, plan))}

    return read


def many(participants, scenarios):
    """So many participants an arm, each with a trial of every scenario."""
    return [
        trial_row(f"{condition}{number}", index, condition, stop_time_s=5.0)
        for condition in ("polmdp", "optimal")
        for number in range(participants)
        for index in range(1, scenarios + 1)
    ]


def test_a_complete_study_as_planned_is_told_nothing_of(told):
    assert told(many(10, 10)) == {}


def test_few_participants_of_an_arm_are_told_with_their_number(told):
    rows = [row for row in many(10, 10) if row["participant"] != "optimal3"]
    assert "Few clusters (participants with optimal: 9). " in told(rows)["few_clusters"]


def test_few_scenarios_are_told_with_their_number(told):
    found = told(many(10, 9), "trials_per_participant = 9")
    assert list(found) == ["few_clusters"]
    assert "(scenarios: 9)" in found["few_clusters"]


def test_scenarios_of_one_arm_only_are_named(told):
    rows = many(10, 10)
    for row in rows:
        if row["condition"] == "optimal" and row["trial_index"] == 10:
            row["scenario"] = "S99"
    assert told(rows)["scenarios_not_shared"].endswith("2 of 11 (S10, S99).")


def test_many_scenarios_of_one_arm_are_counted_and_five_of_them_named(told):
    rows = many(10, 10)
    for row in rows[:-1]:
        row["scenario"] = f"{row['scenario']}{row['condition'][0]}"
    rows[-1]["scenario"] = "S10p"
    text = told(rows)["scenarios_not_shared"]
    assert text.endswith("19 of 20 (S01o, S01p, S02o, S02p, S03o, and 14 more).")


def test_scenarios_of_which_none_is_shared_are_said_to_be_all(told):
    rows = many(10, 10)
    for row in rows:
        row["scenario"] = f"{row['scenario']}{row['condition'][0]}"
    assert told(rows) == {
        "no_scenario_shared": "No scenario was seen in both conditions: how the 20 scenarios "
        "differ cannot be told from what the conditions do."
    }


def test_participants_with_fewer_trials_than_planned_are_counted(told):
    rows = many(10, 10)[:-2]
    assert told(rows)["fewer_trials_than_planned"].endswith(
        "the plan's 10 trials: 1 of 20; the trials they answered are analysed."
    )


def test_a_plan_that_deals_more_trials_than_anyone_has_is_told_so(told):
    found = told(many(10, 9))
    assert found["fewer_trials_than_planned"] == (
        "Nobody has the plan's 10 trials; the most that anyone has are 9."
    )


def test_exclusions_are_told_with_their_number(told):
    plan = '[[exclusions]]\nrule = "incomplete"\nfewer_than = 10'
    assert told([*many(10, 10), trial_row("late", 1, "polmdp")], plan) == {
        "participants_excluded": "Participants excluded by the plan, who answered fewer than 10 "
        "trials: 1."
    }


def test_trials_of_conditions_that_are_not_compared_are_counted(tmp_path):
    kept = ("participant", "condition", "scenario", "trial_index", "correct", "stop_time_s")
    rows = [
        {name: row[name] for name in (*kept, "length_s", "confidence")}
        for row in [*six_participants(), trial_row("P9", 1, "random"), trial_row("P9", 2, "random")]
    ]
    path = as_csv(tmp_path / "t.csv", rows)
    found = data_notices(read_dataset(path, mapping=TableMapping()))
    assert found[0].code == "other_conditions_left_out"
    assert found[0].text.endswith("trials, 2 of random.")
