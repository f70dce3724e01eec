"""Who left, and the primary tests without them and with their whole lists."""

from dataclasses import replace

import pytest

from analysis import PARTICIPANTS, TRIALS, default_plan, read_dataset, write_table
from analysis.exclusions import Exclusion
from analysis.sensitivity import sensitivity
from tests.analysis.rows import participants_of, six_participants, trial_row

THREE_TRIALS = replace(default_plan(), trials_per_participant=3)
WITHOUT_INCOMPLETE = replace(THREE_TRIALS, exclusions=(Exclusion("incomplete", {"fewer_than": 3}),))


def study(tmp_path, rows, left=(), plan=THREE_TRIALS):
    """A study of these trials, in which the participants `left` did not complete."""
    people = [
        person | ({"status": "trials", "trials_s": None} if person["participant"] in left else {})
        for person in participants_of(rows)
    ]
    write_table(TRIALS, rows, tmp_path)
    write_table(PARTICIPANTS, people, tmp_path)
    return read_dataset(tmp_path, plan)


def test_where_everybody_completed_all_selections_agree(tmp_path):
    found = sensitivity(study(tmp_path, six_participants()))
    assert found.intention_to_treat is not None
    assert (found.dropout.estimate, found.dropout.fisher_p) == (0, 1)
    whole = found.completers["confidence"]
    assert whole is not None
    assert whole.estimate == found.intention_to_treat["confidence"].estimate


def test_completers_leave_out_who_left_and_intention_to_treat_fills_their_lists(tmp_path):
    rows = six_participants()[:-1]
    found = sensitivity(study(tmp_path, rows, left=["P6"]))
    completers = found.completers["correct"]
    assert completers is not None
    assert found.intention_to_treat is not None
    assert (found.dropout.left_treatment, found.dropout.left_reference) == (0, 1)
    assert completers.n == 15
    assert completers.estimate == pytest.approx(1 - 4 / 6)
    # the missing trial of P6 counts as wrong
    assert found.intention_to_treat["correct"].n == 18
    assert found.intention_to_treat["correct"].estimate == pytest.approx(1 - 6 / 9)


def test_the_worst_case_is_a_wrong_guess_the_full_length_and_the_lowest_rating(tmp_path):
    found = sensitivity(study(tmp_path, six_participants()))
    assert found.filled_in == {"correct": 0, "prediction_time_s": 20, "confidence": 1}


def test_an_arm_that_nobody_completed_has_no_test_of_completers(tmp_path):
    found = sensitivity(study(tmp_path, six_participants(), left=["P1", "P2", "P3"]))
    assert found.completers["correct"] is None
    assert found.dropout.estimate == 1


def test_where_the_length_of_the_lists_is_unknown_nothing_is_filled_in(tmp_path):
    found = sensitivity(study(tmp_path, six_participants(), plan=default_plan()))
    assert found.intention_to_treat is None


def test_whom_the_plan_excludes_may_have_left_and_is_treated_but_is_no_completer(tmp_path):
    """P3 and P6 leave after two trials and one; the plan excludes whoever answered fewer than 3."""
    rows = [
        row
        for row in six_participants()
        if (row["participant"], row["trial_index"]) not in {("P3", 3), ("P6", 2), ("P6", 3)}
    ]
    path = write_table(TRIALS, rows, tmp_path)[0]
    found, ignoring = (
        sensitivity(read_dataset(path, each)) for each in (WITHOUT_INCOMPLETE, THREE_TRIALS)
    )
    assert found.dropout == ignoring.dropout
    assert (found.dropout.left_treatment, found.dropout.left_reference) == (1, 1)
    assert found.intention_to_treat == ignoring.intention_to_treat
    assert found.filled_in == ignoring.filled_in
    assert found.intention_to_treat is not None
    # 8 of 9 with polmdp; P4 and P5 have 2 of 3 each, P6 one of 3
    assert found.intention_to_treat["correct"].estimate == pytest.approx(8 / 9 - 5 / 9)
    completers = found.completers["correct"]
    assert completers is not None
    assert completers.n == 12
    assert found.counted.startswith("participants with a trial, excluded or not; left: ")


def test_who_finished_and_is_excluded_is_no_completer_but_sets_the_worst_case(tmp_path):
    rows = [row for row in six_participants() if row["participant"] != "P2"]
    rows += [trial_row("P2", n, "polmdp", length_s=38.0, paused_s=30.0) for n in (1, 2, 3)]
    plan = replace(THREE_TRIALS, exclusions=(Exclusion("long_pauses", {"above_s": 60.0}),))
    found = sensitivity(study(tmp_path, rows, plan=plan))
    completers = found.completers["correct"]
    assert completers is not None
    assert found.intention_to_treat is not None
    assert (completers.n, found.intention_to_treat["correct"].n) == (15, 18)
    assert found.filled_in["prediction_time_s"] == pytest.approx((15 * 20 + 3 * 38) / 18)


def test_of_an_exports_people_the_excluded_may_have_left_too(tmp_path):
    found = sensitivity(
        study(tmp_path, six_participants()[:-1], left=["P6"], plan=WITHOUT_INCOMPLETE)
    )
    assert (found.dropout.left_reference, found.dropout.participants_reference) == (1, 3)
    assert found.counted == (
        "participants dealt a condition, excluded or not; left: study not completed"
    )


def test_without_a_participants_table_those_with_fewer_trials_left(tmp_path):
    rows = [*six_participants(), trial_row("P7", 1, "polmdp")]
    data = read_dataset(write_table(TRIALS, rows, tmp_path)[0], THREE_TRIALS)
    found = sensitivity(data)
    assert (found.dropout.left_treatment, found.dropout.participants_treatment) == (1, 4)
    assert found.counted == "participants with a trial; left: fewer than the plan's 3 trials"
