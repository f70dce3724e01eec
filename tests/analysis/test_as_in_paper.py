"""From a data set to the paper's block: who is counted, and what the fixture must give."""

import math

import pytest

from analysis import PARTICIPANTS, TRIALS, EmptyArmError, analyse_path, read_dataset, write_table
from analysis.as_in_paper import as_in_paper
from analysis.demographics import demographics
from analysis.sample import sample
from tests.analysis.rows import (
    as_csv,
    participant_row,
    participants_of,
    six_participants,
    trial_row,
)


@pytest.fixture(scope="module")
def paper(paper_fixture):
    """The block computed from the synthetic trials."""
    return analyse_path(paper_fixture).evidence.paper


def test_the_fixture_gives_the_papers_chi_square(paper):
    assert f"{paper.correct.test.statistic:.3f}" == "48.864"
    assert paper.correct.test.df == 1


def test_the_fixture_gives_the_papers_shares(paper):
    shares = {arm: f"{100 * each.share:.0f} %" for arm, each in paper.correct.arms.items()}
    assert shares == {"polmdp": "85 %", "optimal": "70 %"}


def test_the_fixture_gives_the_papers_times(paper):
    arms = paper.prediction_time.arms
    assert (f"{arms['polmdp'].mean:.2f}", f"{arms['optimal'].mean:.2f}") == ("15.67", "18.22")
    assert paper.prediction_time.test.u_smaller == 177976
    assert paper.prediction_time.test.p < 0.001


def test_the_fixture_gives_the_papers_confidence(paper):
    arms = paper.confidence.arms
    assert (f"{arms['polmdp'].mean:.2f}", f"{arms['optimal'].mean:.2f}") == ("6.08", "5.78")
    assert paper.confidence.test.u_smaller == 231203
    assert paper.confidence.test.u_treatment == 278397
    assert f"{paper.confidence.test.p:.3f}" == "0.001"


def test_the_fixture_has_98_and_52_participants(paper):
    arms = paper.sample.arms
    assert [arm.participants for arm in arms.values()] == [98, 52]
    assert [arm.trials for arm in arms.values()] == [980, 520]
    assert paper.demographics is None


def test_a_wrong_answer_counts_with_its_full_length(export):
    block = as_in_paper(read_dataset(export))
    # P4-P6: stops after 10, 11 and 12 s and one s later, then a wrong answer at 20 s
    assert block.prediction_time.arms["optimal"].mean == pytest.approx((33 + 36 + 60) / 9)
    assert block.correct.table.reference_wrong == 3


def test_the_order_of_trials_changes_no_number(tmp_path):
    rows = six_participants()
    forth = as_in_paper(read_dataset(write_table(TRIALS, rows, tmp_path / "a")[0]))
    back = as_in_paper(read_dataset(write_table(TRIALS, rows[::-1], tmp_path / "b")[0]))
    assert forth.correct == back.correct
    assert forth.prediction_time.test == back.prediction_time.test
    for arm, one in forth.prediction_time.arms.items():
        assert math.isclose(one.mean, back.prediction_time.arms[arm].mean)


def test_swapping_the_labels_mirrors_the_tests(tmp_path):
    rows = six_participants()
    other = {"polmdp": "optimal", "optimal": "polmdp"}
    swapped = [row | {"condition": other[row["condition"]]} for row in rows]
    one = as_in_paper(read_dataset(write_table(TRIALS, rows, tmp_path / "a")[0]))
    two = as_in_paper(read_dataset(write_table(TRIALS, swapped, tmp_path / "b")[0]))
    assert one.correct.test.statistic == pytest.approx(two.correct.test.statistic)
    assert two.correct.test.estimate is not None
    assert one.correct.test.estimate == pytest.approx(-two.correct.test.estimate)
    assert one.confidence.test.u_treatment == two.confidence.test.u_reference
    assert one.confidence.test.p == pytest.approx(two.confidence.test.p)


def test_incomplete_participants_stay_in_and_are_counted_by_their_status(tmp_path):
    rows = six_participants()[:-1]
    people = participants_of(rows)
    people[-1] |= {"status": "trials", "trials_s": None}
    write_table(TRIALS, rows, tmp_path)
    write_table(PARTICIPANTS, people, tmp_path)
    found = sample(read_dataset(tmp_path))
    assert (found.arms["optimal"].incomplete, found.arms["polmdp"].incomplete) == (1, 0)
    assert found.arms["optimal"].trials == 8
    assert (found.arms["optimal"].fewest_trials, found.arms["optimal"].most_trials) == (2, 3)
    assert found.incomplete_means == "study not completed"


def test_without_their_table_incomplete_are_those_with_fewer_trials(tmp_path):
    path = write_table(TRIALS, six_participants()[:-1], tmp_path)[0]
    found = sample(read_dataset(path))
    assert found.arms["optimal"].incomplete == 1
    assert found.arms["optimal"].without_trials is None
    assert found.incomplete_means == "fewer than 3 trials, the most that anyone has"


def test_who_was_dealt_a_place_and_answered_nothing_is_counted(tmp_path):
    rows = six_participants()
    idle = [participant_row("P7", "optimal", status="trials"), participant_row("P8", None)]
    write_table(TRIALS, rows, tmp_path)
    write_table(PARTICIPANTS, [*participants_of(rows), *idle], tmp_path)
    found = sample(read_dataset(tmp_path))
    assert found.arms["optimal"].without_trials == 1
    assert found.arms["polmdp"].without_trials == 0
    assert found.arms["optimal"].participants == 3


def study_of(tmp_path, answers):
    """A study in which each participant gave these answers; the first three are polmdp's."""
    rows = six_participants()
    people = [person | given for person, given in zip(participants_of(rows), answers, strict=True)]
    write_table(TRIALS, rows, tmp_path)
    write_table(PARTICIPANTS, [*people, participant_row("P9", "optimal", age=99)], tmp_path)
    return demographics(read_dataset(tmp_path))


def test_demographics_count_answers_per_condition_and_over_all(tmp_path):
    genders = ["woman", "man", "woman", "man", "prefer not to say", None]
    found = study_of(tmp_path, [{"gender": gender} for gender in genders])
    table = {row.answer: tuple(row.counts.values()) for row in found.answers["gender"]}
    assert table == {
        "man": (1, 1, 2),
        "woman": (2, 0, 2),
        "no answer": (0, 1, 1),
        "prefer not to say": (0, 1, 1),
    }
    assert found.n == {"polmdp": 3, "optimal": 3, "overall": 6}


def test_demographics_list_the_most_frequent_answer_first(tmp_path):
    education = ["master", "master", "none", "none", "none", "a doctorate"]
    found = study_of(tmp_path, [{"education": each} for each in education])
    assert [row.answer for row in found.answers["education"]] == ["none", "master", "a doctorate"]


def test_demographics_describe_the_age_of_those_who_told_it(tmp_path):
    found = study_of(tmp_path, [{"age": age} for age in (20, 30, 40, None, None, None)])
    told = found.age["polmdp"]
    assert (told.mean, told.sd, told.minimum, told.maximum) == (30, 10, 20, 40)
    assert found.age["optimal"] is None
    assert (found.age["overall"].n, found.age["overall"].n_missing) == (3, 3)


def test_world_regions_follow_from_nationalities_and_sum_to_everybody(tmp_path):
    told = ["Portuguese", "UK", "prefer not to say", "portugal ", "US/UK", "Klingon"]
    found = study_of(tmp_path, [{"nationality": nationality} for nationality in told])
    assert [(row.answer, tuple(row.counts.values())) for row in found.regions] == [
        ("Europe", (2, 1, 3)),
        ("several", (0, 1, 1)),
        ("not recognised", (0, 1, 1)),
        ("not told", (1, 0, 1)),
    ]
    for group, participants in found.n.items():
        assert sum(row.counts[group] for row in found.regions) == participants
    assert len(found.answers["nationality"]) == 6


def test_what_is_no_region_stands_last_however_frequent_it_is(tmp_path):
    told = ["Klingon", "Klingon", "UK", None, None, None]
    found = study_of(tmp_path, [{"nationality": nationality} for nationality in told])
    assert [row.answer for row in found.regions] == ["Europe", "not recognised", "not told"]


def test_an_arm_without_any_confidence_is_a_structured_error(tmp_path):
    rows = [
        {
            "participant": f"P{number}",
            "condition": condition,
            "scenario": "S",
            "trial_index": 1,
            "correct": True,
            "stop_time_s": 1,
            "length_s": 2,
            "confidence": confidence,
        }
        for number, condition, confidence in ((1, "polmdp", 3), (2, "optimal", None))
    ]
    with pytest.raises(EmptyArmError, match=r"^t.csv, condition optimal: .* confidence"):
        analyse_path(as_csv(tmp_path / "t.csv", rows))


def test_a_trial_each_is_enough_for_the_block(tmp_path):
    rows = [trial_row("P1", 1, "polmdp"), trial_row("P2", 1, "optimal")]
    block = as_in_paper(read_dataset(write_table(TRIALS, rows, tmp_path)[0]))
    assert block.correct.test.warnings == ("degenerate_margin",)
    assert block.prediction_time.test.warnings == ("constant_outcome",)
    assert block.confidence.arms["polmdp"].low is None
