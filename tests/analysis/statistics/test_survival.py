"""Cumulative incidence against closed forms, statsmodels and its own definition, slowly."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from statsmodels.duration.survfunc import CumIncidenceRight

from analysis.errors import EmptyArmError
from analysis.statistics.codes import ONE_PARTICIPANT
from analysis.statistics.outcome import UNKNOWN
from analysis.statistics.survival import (
    CENSORED,
    CORRECT,
    GRID,
    WRONG,
    Stops,
    cumulative_incidence,
    stops,
)

TRIALS = st.lists(
    st.tuples(
        st.integers(1, 8),  # time
        st.sampled_from([CENSORED, CORRECT, WRONG]),
        st.integers(0, 5),  # participant; the even ones are treated
    ),
    min_size=1,
    max_size=40,
)


def made(trials):
    """Stops of both arms from (time, ending, participant), two more trials in each arm."""
    trials = [*trials, *((9, CORRECT, who) for who in range(4))]
    time, ending, who = (np.array(column) for column in zip(*trials, strict=True))
    return Stops(time.astype(float), ending.astype(np.int8), who % 2 == 0, who, who, 0)


def many(seed, n=600):
    """Random stops without ties, some of them censored, ten to a participant."""
    rng = np.random.default_rng(seed)
    time, who = rng.random(n), np.arange(n) // 10
    ending = np.where(time > 0.9, CENSORED, rng.integers(0, 3, n)).astype(np.int8)
    return Stops(time, ending, who % 2 == 0, who, who, 0)


def some(given, which):
    """Some of the trials: a mask or numbers."""
    return Stops(
        given.time_s[which],
        given.ending[which],
        given.treated[which],
        given.participant[which],
        given.scenario[which],
        given.n_missing,
    )


def estimated(given):
    """The result, untyped: here both arms have more than one participant, so intervals exist."""
    return cumulative_incidence(given)


def weighted_incidence(time, ending, cause, by, weights):
    """Aalen-Johansen by its definition, one time after the other."""
    survival, incidence = 1.0, 0.0
    for moment in np.unique(time[time <= by]):
        at_risk = weights[time >= moment].sum()
        here = (time == moment) * weights
        incidence += survival * here[ending == cause].sum() / at_risk
        survival *= 1 - here[ending != CENSORED].sum() / at_risk
    return incidence


def test_a_stop_at_the_length_is_no_stop():
    found = stops(
        stop_time_s=np.array([3.0, 4.0, 9.0, 9.0]),
        length_s=np.full(4, 9.0),
        correct=np.array([1.0, 0.0, 1.0, 0.0]),
        treated=np.array([True, False, True, False]),
        participant=np.array([4, 7, 4, 7]),
        scenario=np.array([5, UNKNOWN, 5, 2]),
    )
    assert found.ending.tolist() == [CORRECT, WRONG, CENSORED, CENSORED]
    assert found.participant.tolist() == [0, 1, 0, 1]
    assert found.scenario.tolist() == [1, UNKNOWN, 1, 0]
    assert found.n_missing == 0


def test_trials_that_lack_time_length_or_guess_are_left_out_and_counted():
    nan = float("nan")
    found = stops(
        stop_time_s=np.array([1.0, nan, 1.0, 1.0, 2.0]),
        length_s=np.array([9.0, 9.0, nan, 9.0, 9.0]),
        correct=np.array([1.0, 1.0, 1.0, nan, 0.0]),
        treated=np.array([True, True, True, False, False]),
        participant=np.arange(5),
        scenario=np.arange(5),
    )
    assert found.time_s.tolist() == [1.0, 2.0]
    assert found.n_missing == 3


def test_an_arm_without_trials_is_an_error():
    one = np.array([1.0])
    with pytest.raises(EmptyArmError, match="condition reference"):
        stops(one, 9 * one, one, np.array([True]), np.array([0]), np.array([0]))


@pytest.mark.parametrize("cause", [CORRECT, WRONG])
def test_the_curve_is_that_of_statsmodels(cause):
    given = many(1, 150)
    found = cumulative_incidence(given)
    for arm, of_arm in ((found.treatment, given.treated), (found.reference, ~given.treated)):
        theirs = CumIncidenceRight(given.time_s[of_arm], given.ending[of_arm].astype(int))
        past = np.searchsorted(theirs.times, found.time_s, side="right")
        expected = np.append(0.0, theirs.cinc[cause - 1])[past]
        curve = arm.correct if cause == CORRECT else arm.wrong
        assert curve.share == pytest.approx(expected, abs=1e-12)


@given(TRIALS)
def test_the_curves_follow_their_definition_and_so_does_their_error(trials):
    given = made(trials)
    found = estimated(given)
    time, ending = given.time_s[given.treated], given.ending[given.treated]
    _, who = np.unique(given.participant[given.treated], return_inverse=True)
    size = who.max() + 1
    for cause, curve in ((CORRECT, found.treatment.correct), (WRONG, found.treatment.wrong)):
        for by, share, se in zip(found.time_s, curve.share, curve.se, strict=True):
            assert share == pytest.approx(
                weighted_incidence(time, ending, cause, by, np.ones(len(time))), abs=1e-12
            )
            # the infinitesimal jackknife: how the curve moves when a participant counts more
            step = 1e-6
            moves = [
                (
                    weighted_incidence(time, ending, cause, by, 1 + step * (who == one))
                    - weighted_incidence(time, ending, cause, by, 1 - step * (who == one))
                )
                / (2 * step)
                for one in range(size)
            ]
            expected = np.sqrt(np.square(moves).sum() * size / (size - 1))
            assert se == pytest.approx(expected, abs=1e-6)


def test_where_nothing_is_censored_it_is_the_clustered_error_of_a_share():
    given = many(2)
    ending = np.where(given.ending == CENSORED, WRONG, given.ending)
    given = replace(given, ending=ending)
    found = estimated(given)
    stopped = (given.time_s <= found.time_s[:, None]) & (ending == CORRECT)
    stopped = stopped[:, given.treated]
    share = stopped.mean(axis=1)
    sums = (stopped - share[:, None]).reshape(len(share), 30, 10).sum(axis=2) / 300
    curve = found.treatment.correct
    assert curve.share == pytest.approx(share)
    assert curve.se == pytest.approx(np.sqrt(30 / 29 * (sums**2).sum(axis=1)))


@given(TRIALS)
def test_shares_rise_from_0_within_their_intervals_and_leave_room_for_each_other(trials):
    found = estimated(made(trials))
    assert found.time_s[0] == 0
    for arm in (found.treatment, found.reference):
        assert (arm.correct.share + arm.wrong.share <= 1 + 1e-12).all()
        for curve in (arm.correct, arm.wrong):
            assert curve.share[0] == curve.low[0] == curve.high[0] == 0
            assert (np.diff(curve.share) >= 0).all()
            assert (curve.low >= 0).all()
            assert (curve.low <= curve.share + 1e-12).all()
            assert (curve.share <= curve.high + 1e-12).all()
            assert (curve.high <= 1).all()


def test_the_interval_is_symmetric_on_the_log_log_scale():
    curve = estimated(many(3)).treatment.correct
    inside = (curve.share > 0) & (curve.share < 1)
    low, mid, high = (
        np.log(-np.log(values[inside])) for values in (curve.low, curve.share, curve.high)
    )
    share = curve.share[inside]
    width = 1.959963984540054 * curve.se[inside] / (share * -np.log(share))
    assert low - mid == pytest.approx(width)
    assert mid - high == pytest.approx(width)


def test_everybody_is_counted_once():
    given = many(4)
    found = cumulative_incidence(given)
    arm = found.treatment
    assert (found.n, arm.n, arm.n_participants, arm.at_risk[0]) == (600, 300, 30, 300)
    assert arm.n_correct == ((given.ending == CORRECT) & given.treated).sum()
    assert arm.n_correct + arm.n_wrong + arm.n_censored == arm.n
    later = given.time_s[given.treated] >= found.time_s[50]
    assert arm.at_risk[50] == later.sum()


@given(TRIALS, st.randoms())
def test_the_order_of_trials_changes_nothing(trials, random):
    one = estimated(made(trials))
    random.shuffle(trials)
    other = estimated(made(trials))
    assert one.treatment.correct.share == pytest.approx(other.treatment.correct.share)
    assert one.treatment.correct.se == pytest.approx(other.treatment.correct.se, abs=1e-9)


@given(TRIALS)
def test_more_of_the_same_from_the_same_participants_makes_nothing_surer(trials):
    once = made(trials)
    twice = some(once, np.tile(np.arange(len(once.time_s)), 2))
    one, other = (estimated(each).reference.wrong for each in (once, twice))
    assert one.share == pytest.approx(other.share)
    assert one.se == pytest.approx(other.se, abs=1e-9)


def test_of_many_times_only_quantiles_are_given_and_there_the_curve_is_exact():
    given = many(5, 2000)
    found = cumulative_incidence(given)
    assert len(found.time_s) == GRID + 1
    assert found.time_s[-1] == given.time_s.max()
    time, ending = given.time_s[given.treated], given.ending[given.treated]
    expected = weighted_incidence(time, ending, WRONG, found.time_s[40], np.ones(len(time)))
    assert found.treatment.wrong.share[40] == pytest.approx(expected)


def test_one_participant_has_curves_but_no_intervals():
    given = many(6)
    kept = ~given.treated | (given.participant == 0)
    found = cumulative_incidence(some(given, kept))
    assert found.warnings == (ONE_PARTICIPANT,)
    assert (found.treatment.n_participants, found.treatment.correct.low) == (1, None)
    assert found.reference.correct.low is not None


def test_all_ending_at_once_ends_the_curve_there():
    who = np.arange(8)
    given = Stops(np.full(8, 2.0), np.full(8, CORRECT, np.int8), who < 4, who, who, 0)
    found = estimated(given)
    assert found.time_s.tolist() == [0, 2]
    assert found.treatment.correct.share.tolist() == [0, 1]
    assert found.treatment.correct.se == pytest.approx([0, 0])
    assert found.treatment.wrong.share.tolist() == [0, 0]
