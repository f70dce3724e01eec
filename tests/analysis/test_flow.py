"""The flow of participants: everybody is in it, and every step follows from the one before."""

from itertools import pairwise

import polars as pl
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis import PARTICIPANTS, TRIALS, read_dataset, read_plan, write_table
from analysis.contract import STATUSES
from analysis.exclusions import Excluded, Exclusion
from analysis.flow import participant_flow
from analysis.plan import default_plan
from analysis.tables import frame_of
from tests.analysis.rows import START, participant_row, participants_of, six_participants

PLAN = default_plan()
TEXTS = {"participant": pl.String, "condition": pl.String}


def told(flow):
    """Each step and who left after it, as (what, total) pairs."""
    return [
        (step.reached.what, step.reached.total, {each.what: each.total for each in step.left})
        for step in flow.steps
    ]


@pytest.fixture
def study(tmp_path):
    """Six who played, and one of each kind that did not come so far."""
    rows = six_participants()
    undealt = {"dealt_at": None, "first_played_at": None}
    others = [
        participant_row("Q1", None, status="screened_out", **undealt),
        participant_row("Q2", None, status="failed", **undealt),
        participant_row("Q3", None, status="withdrawn", **undealt),
        participant_row("Q4", None, status="instructions", **undealt),
        participant_row("Q5", None, status="trials", first_played_at=None),
        participant_row("Q6", "polmdp", status="trials", first_played_at=None),
        participant_row("Q7", "optimal", status="withdrawn", first_played_at=None),
        participant_row("Q8", "optimal", status="trials"),
        participant_row("Q9", "polmdp", status="withdrawn"),
    ]
    people = participants_of(rows)
    people[0] |= {"status": "trials", "trials_s": None}
    people[1]["control_tries"] = 2
    write_table(TRIALS, rows, tmp_path)
    write_table(PARTICIPANTS, [*people, *others], tmp_path)
    return tmp_path


def test_every_way_out_of_the_study_is_told(study):
    flow = read_dataset(study).flow
    assert told(flow) == [
        (
            "gave consent",
            15,
            {
                "screened out": 1,
                "failed the control question": 1,
                "withdrew": 1,
                "gave the place back unplayed": 1,
                "stopped before a place was dealt": 1,
            },
        ),
        ("dealt a place", 10, {"withdrew": 1, "never began a trial": 1}),
        ("played", 8, {"withdrew": 1, "answered no trial": 1}),
        ("answered a trial", 6, {}),
        ("analysed", 6, {}),
    ]


def test_conditions_are_told_from_the_dealing_on(study):
    consented, dealt, played, answered, analysed = read_dataset(study).flow.steps
    assert consented.reached.arms is None
    assert dealt.reached.arms == {"polmdp": 5, "optimal": 5}
    assert dealt.left[1].arms == {"polmdp": 1, "optimal": 0}
    assert played.reached.arms == {"polmdp": 4, "optimal": 4}
    assert answered.of_these[0].what == "completed the study"
    assert answered.of_these[0].arms == {"polmdp": 2, "optimal": 3}
    assert analysed.of_these == answered.of_these


def test_exclusions_are_told_rule_by_rule_even_if_they_took_nobody(study, tmp_path):
    plan = tmp_path / "mine.toml"
    plan.write_text(
        '[[exclusions]]\nrule = "never_moved_pointer"\n'
        '[[exclusions]]\nrule = "failed_control_question"\ntries_above = 1\n'
    )
    answered, analysed = read_dataset(study, read_plan(plan)).flow.steps[-2:]
    assert [(each.what, each.arms) for each in answered.left] == [
        ("never moved the pointer", {"polmdp": 0, "optimal": 0}),
        ("needed more tries than 1 for the control question", {"polmdp": 1, "optimal": 0}),
    ]
    assert analysed.reached.arms == {"polmdp": 2, "optimal": 3}


def test_a_single_table_of_trials_begins_with_the_answers(tmp_path):
    path = write_table(TRIALS, six_participants()[:-1], tmp_path)[0]
    flow = read_dataset(path).flow
    assert told(flow) == [("answered a trial", 6, {}), ("analysed", 6, {})]
    (finished,) = flow.steps[-1].of_these
    assert finished.what == "answered as many trials as anyone"
    assert finished.arms == {"polmdp": 3, "optimal": 2}


PEOPLE = st.lists(
    st.tuples(
        st.sampled_from([None, *PLAN.arms.names]),
        st.sampled_from(STATUSES),
        st.booleans(),
        st.booleans(),
        st.integers(0, 2),
    ),
    min_size=1,
    max_size=12,
)


@given(PEOPLE)
def test_each_step_less_those_who_left_is_the_next(people):
    """Whatever the tables hold, nobody is lost between steps or counted twice."""
    rows, trials = [], []
    for number, (condition, status, was_dealt, played, answered) in enumerate(people):
        rows.append(
            participant_row(
                f"P{number}",
                condition,
                status=status,
                dealt_at=START if was_dealt else None,
                first_played_at=START if played else None,
            )
        )
        if condition is not None:
            trials += [(f"P{number}", condition)] * answered
    everyone = frame_of(PARTICIPANTS, rows)
    import polars as pl

    answers = pl.DataFrame(trials, schema=["participant", "condition"], orient="row").cast(
        pl.String
    )
    names = answers["participant"].unique().sort().to_list()
    taken = (
        Excluded(Exclusion("same_guess", {}), tuple(names[:1])),
        Excluded(Exclusion("duplicate_stimuli", {}), tuple(names[1:3])),
    )
    flow = participant_flow(PLAN, answers, everyone, {}, taken)
    assert flow.steps[0].reached.total == len(people)
    assert flow.steps[-1].reached.total == max(0, len(names) - 3)
    for step, following in pairwise(flow.steps):
        left = sum(each.total for each in step.left)
        assert step.reached.total - left == following.reached.total
        if step.reached.arms is not None:
            for arm, count in step.reached.arms.items():
                gone = sum((each.arms or {})[arm] for each in step.left)
                assert following.reached.arms is not None
                assert count - gone == following.reached.arms[arm]
