"""What a trial is worth: each measure against numbers worked out by hand, and its rules."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis import correct, prediction_time_s, score, too_fast

LENGTHS = st.floats(0.1, 600)
SHARES = st.floats(0, 1)


def test_a_guess_is_correct_only_where_the_robot_was_going():
    assert correct("C", "C") is True
    assert correct("C", "D") is False


def test_a_correct_guess_counts_the_stop_time():
    assert prediction_time_s(5.5, 20.0, True) == 5.5


def test_a_wrong_guess_counts_the_full_length():
    assert prediction_time_s(3.2, 18.5, False) == 18.5


def test_a_wrong_guess_scores_nothing_however_early():
    assert score(False, 0.0, 20.0) == 0.0


@pytest.mark.parametrize(
    ("stop_time_s", "points"),
    [(0.0, 10.0), (7.0, 10.0), (8.4, 9.0), (14.0, 5.0), (21.0, 0.0)],
)
def test_a_correct_guess_scores_ten_in_the_first_third_then_less_and_less(stop_time_s, points):
    assert score(True, stop_time_s, 21.0) == pytest.approx(points)


@given(LENGTHS, SHARES)
def test_a_score_lies_between_nothing_and_ten(length_s, part):
    assert 0.0 <= score(True, part * length_s, length_s) <= 10.0


@given(LENGTHS, SHARES, SHARES)
def test_stopping_later_never_scores_more(length_s, one, other):
    early, late = sorted((one * length_s, other * length_s))
    assert score(True, late, length_s) <= score(True, early, length_s)


@given(LENGTHS, SHARES, st.floats(0.5, 4))
def test_only_the_part_seen_matters_for_the_score(length_s, part, factor):
    one = score(True, part * length_s, length_s)
    other = score(True, part * length_s * factor, length_s * factor)
    assert one == pytest.approx(other, abs=1e-9)


@given(LENGTHS, SHARES, st.booleans())
def test_time_of_prediction_is_never_before_the_stop_nor_after_the_end(length_s, part, right):
    stop_time_s = part * length_s
    assert stop_time_s <= prediction_time_s(stop_time_s, length_s, right) <= length_s


@pytest.mark.parametrize(
    ("stop_time_s", "verdict"), [(0.0, True), (2.999, True), (3.0, False), (20.0, False)]
)
def test_a_stop_is_too_fast_until_the_first_decision_has_been_seen_whole(stop_time_s, verdict):
    assert too_fast(stop_time_s, 3.0) is verdict
