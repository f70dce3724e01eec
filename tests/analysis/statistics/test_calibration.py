"""Accuracy along confidence and time, and whether confidence tells right from wrong."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis.errors import EmptyArmError
from analysis.statistics.calibration import (
    TIME_BINS,
    accuracy_by_confidence,
    accuracy_by_time,
    discrimination,
)
from analysis.statistics.codes import CONSTANT_OUTCOME, FEW_CLUSTERS, ONE_PARTICIPANT
from analysis.statistics.outcome import Outcome

NAN = float("nan")
LEVELS = range(1, 8)
TRIALS = st.lists(
    st.tuples(st.booleans(), st.integers(1, 7), st.integers(0, 11)), min_size=1, max_size=60
)


def guesses(correct, participant, treated=None):
    """Correct guesses (1, 0, NaN) of these participants; the even ones are treated."""
    participant = np.asarray(participant)
    return Outcome(
        name="correct",
        unit="proportion",
        y=np.asarray(correct, dtype=float),
        treated=participant % 2 == 0 if treated is None else np.asarray(treated),
        participant=participant,
        scenario=np.zeros(len(participant), dtype=np.int64),
    )


def made(trials):
    """Guesses and ratings from (correct, confidence, participant), and two of each of four."""
    trials = [*trials, *((right, 4, who) for right in (True, False) for who in range(4))]
    correct, confidence, who = (np.array(column) for column in zip(*trials, strict=True))
    return guesses(correct, who), confidence.astype(float)


@given(TRIALS)
def test_every_trial_is_counted_at_its_level_in_its_arm(trials):
    correct, confidence = made(trials)
    found = accuracy_by_confidence(correct, confidence, LEVELS)
    for arm, of_arm in ((found.treatment, correct.treated), (found.reference, ~correct.treated)):
        assert [row.lower for row in arm] == [row.upper for row in arm] == list(LEVELS)
        for row in arm:
            y = correct.y[of_arm & (confidence == row.lower)]
            assert (row.n, row.n_correct) == (len(y), y.sum())
            if len(y):
                assert row.share == pytest.approx(y.mean())
                assert row.mean == pytest.approx(row.lower)
            else:
                assert (row.share, row.mean, row.low, row.high) == (None, None, None, None)


@given(TRIALS)
def test_the_share_lies_in_its_interval_and_that_in_0_to_1(trials):
    correct, confidence = made(trials)
    found = accuracy_by_confidence(correct, confidence, LEVELS)
    for row in (*found.treatment, *found.reference):
        assert (row.low is None) == (row.high is None) == (row.n_participants < 2)
        if row.share is not None and row.low is not None and row.high is not None:
            assert 0 <= row.low <= row.share + 1e-12
            assert row.share - 1e-12 <= row.high <= 1


def test_the_interval_is_wilsons_where_each_participant_has_one_trial():
    """But for t in place of z, and n - 1 in place of n: too little to see at 2,000."""
    n, right = 2000, 1500
    who = np.arange(2 * n)
    correct = guesses(np.repeat(np.arange(n) < right, 2), who)
    row = accuracy_by_confidence(correct, np.full(2 * n, 5.0), LEVELS).treatment[4]
    wilson = stats.binomtest(right, n).proportion_ci(0.95, method="wilson")
    assert [row.low, row.high] == pytest.approx([wilson.low, wilson.high], abs=2e-5)


def test_participants_who_always_repeat_themselves_count_once():
    """Ten equal trials each: the interval is that of one trial each, with t for z."""
    right = np.arange(40) % 4 != 0
    once = accuracy_by_confidence(
        guesses(np.repeat(right, 2), np.arange(80)), np.full(80, 3.0), LEVELS
    )
    tenfold = accuracy_by_confidence(
        guesses(np.repeat(right, 20), np.tile(np.arange(80), 10).reshape(10, 80).T.ravel()),
        np.full(800, 3.0),
        LEVELS,
    )
    one, other = once.treatment[2], tenfold.treatment[2]
    assert (other.n, other.n_participants) == (400, 40)
    assert (one.low, one.high) == pytest.approx((other.low, other.high))


def test_all_right_is_as_sure_as_there_are_participants():
    correct = guesses(np.ones(60), np.repeat(np.arange(6), 10))
    row = accuracy_by_confidence(correct, np.full(60, 7.0), LEVELS).treatment[6]
    t2 = stats.t.ppf(0.975, 2) ** 2
    assert row.high == 1
    assert row.low == pytest.approx(3 / (3 + t2))  # Wilson's of 3 among 3


def test_one_participant_has_a_share_and_no_interval():
    row = accuracy_by_confidence(guesses([1, 0, 1], [0, 0, 1]), np.full(3, 2.0), LEVELS).treatment[
        1
    ]
    assert (row.share, row.low, row.high, row.n_participants) == (0.5, None, None, 1)


def test_trials_without_guess_or_value_are_left_out_and_counted():
    correct = guesses([1, NAN, 0, 1], [0, 0, 1, 2])
    confidence = np.array([7.0, 7.0, 7.0, NAN])
    found = accuracy_by_confidence(correct, confidence, LEVELS)
    assert (found.n, found.n_missing) == (2, 2)
    assert (found.treatment[6].n, found.reference[6].n) == (1, 1)
    treatment, reference = discrimination(correct, confidence)
    assert (treatment.n_missing, reference.n_missing) == (2, 0)


def test_an_arm_without_values_is_an_error():
    correct, nothing = guesses([1, 0], [0, 1]), np.array([4.0, NAN])
    with pytest.raises(EmptyArmError, match="condition reference"):
        accuracy_by_confidence(correct, nothing, LEVELS)
    with pytest.raises(EmptyArmError, match="condition reference"):
        accuracy_by_time(correct, nothing)
    with pytest.raises(EmptyArmError, match="condition reference"):
        discrimination(correct, nothing)


def test_bins_of_time_are_tenths_shared_by_both_arms():
    rng = np.random.default_rng(7)
    correct = guesses(rng.integers(0, 2, 500), np.arange(500) // 10)
    time = rng.exponential(9, 500)
    found = accuracy_by_time(correct, time)
    assert len(found.treatment) == len(found.reference) == TIME_BINS
    assert [a.n + b.n for a, b in zip(found.treatment, found.reference, strict=True)] == [50] * 10
    for one, other in zip(found.treatment, found.reference, strict=True):
        assert (one.lower, one.upper) == (other.lower, other.upper)
        here = correct.treated & (time > one.lower) & (time <= one.upper)
        if one.lower == time.min():
            here |= correct.treated & (time == one.lower)
        assert one.share == pytest.approx(correct.y[here].mean())
        assert one.mean == pytest.approx(time[here].mean())


@given(TRIALS)
def test_tied_times_fall_in_one_bin_and_none_is_lost(trials):
    correct, time = made(trials)
    found = accuracy_by_time(correct, time)
    uppers = [row.upper for row in found.treatment]
    assert uppers == sorted(set(uppers))
    assert sum(row.n for row in (*found.treatment, *found.reference)) == len(time)


def test_equal_times_make_one_bin():
    found = accuracy_by_time(guesses([1, 0, 1, 0], [0, 1, 2, 3]), np.full(4, 6.0))
    (row,) = found.treatment
    assert (row.lower, row.upper, row.n, row.share) == (6, 6, 2, 1)


@given(TRIALS)
def test_the_auc_counts_pairs_and_gamma_those_not_tied(trials):
    correct, confidence = made(trials)
    for test, of_arm in zip(
        discrimination(correct, confidence), (correct.treated, ~correct.treated), strict=True
    ):
        right, wrong = (confidence[of_arm & (correct.y == guess)] for guess in (1, 0))
        wins = (right[:, None] > wrong).sum()
        losses = (right[:, None] < wrong).sum()
        ties = (right[:, None] == wrong).sum()
        assert test.estimate == pytest.approx((wins + ties / 2) / (wins + losses + ties))
        assert (test.n_correct, test.n_wrong) == (len(right), len(wrong))
        if wins + losses:
            assert test.gamma == pytest.approx((wins - losses) / (wins + losses), abs=1e-12)


@given(TRIALS)
def test_discrimination_sees_only_the_order_of_ratings(trials):
    correct, confidence = made(trials)
    assert discrimination(correct, confidence) == discrimination(correct, confidence**3)


@given(TRIALS)
def test_turning_the_scale_round_turns_discrimination_round(trials):
    correct, confidence = made(trials)
    for one, other in zip(
        discrimination(correct, confidence), discrimination(correct, 8 - confidence), strict=True
    ):
        assert one.estimate is not None
        assert other.estimate == pytest.approx(1 - one.estimate)
        if one.se is not None and other.se is not None:
            assert one.se == pytest.approx(other.se)


def test_the_error_of_discrimination_is_delongs_where_each_participant_has_one_trial():
    rng = np.random.default_rng(8)
    n = 400
    correct = guesses(rng.random(2 * n) < 0.7, np.arange(2 * n))
    confidence = np.round(4 + correct.y + rng.normal(size=2 * n))
    test = discrimination(correct, confidence)[0]
    arm = correct.treated
    right, wrong = (confidence[arm & (correct.y == guess)] for guess in (1, 0))
    beats = (right[:, None] > wrong) + (right[:, None] == wrong) / 2
    delong = beats.mean(axis=1).var() / len(right) + beats.mean(axis=0).var() / len(wrong)
    assert test.se == pytest.approx(np.sqrt(delong * n / (n - 1)))
    assert (test.df, test.null, test.warnings) == (n - 1, 0.5, ())


def test_more_of_the_same_trials_does_not_shrink_the_error():
    rng = np.random.default_rng(9)
    who = np.repeat(np.arange(60), 5)
    correct, confidence = rng.integers(0, 2, 300), rng.integers(1, 8, 300).astype(float)
    once = discrimination(guesses(correct, who), confidence)[1]
    twice = discrimination(guesses(np.tile(correct, 2), np.tile(who, 2)), np.tile(confidence, 2))[1]
    assert (once.estimate, once.se) == pytest.approx((twice.estimate, twice.se))


@pytest.mark.parametrize("guess", [0, 1])
def test_nothing_can_be_told_apart_where_all_guesses_are_alike(guess):
    correct = guesses([guess, guess, 1, 0], [0, 2, 1, 3])
    test = discrimination(correct, np.array([1.0, 5.0, 3.0, 2.0]))[0]
    assert (test.estimate, test.p, test.gamma) == (None, None, None)
    assert test.warnings == (CONSTANT_OUTCOME,)


def test_equal_ratings_tell_nothing():
    correct = guesses([1, 0] * 20, np.arange(40) // 2)
    test = discrimination(correct, np.full(40, 6.0))[0]
    assert (test.estimate, test.gamma, test.p) == (0.5, None, 1.0)


def test_one_participant_has_an_auc_and_no_error():
    test = discrimination(guesses([1, 0, 1, 0], [0, 0, 1, 3]), np.array([6.0, 3.0, 4.0, 4.0]))[0]
    assert (test.estimate, test.se, test.warnings) == (1.0, None, (ONE_PARTICIPANT,))


def test_few_participants_are_warned_of():
    rng = np.random.default_rng(10)
    correct = guesses(rng.integers(0, 2, 60), np.repeat(np.arange(6), 10))
    assert discrimination(correct, rng.random(60))[0].warnings == (FEW_CLUSTERS,)
