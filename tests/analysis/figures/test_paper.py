"""The figures show the numbers honestly: axes, intervals, medians, labels."""

import numpy as np
import pytest

from analysis import TRIALS, read_dataset, write_table
from analysis.as_in_paper import as_in_paper, values_of
from analysis.contract import CONDITIONS
from analysis.figures import (
    confidence_scale,
    figure_confidence,
    figure_correct,
    figure_prediction_time,
    write_figure,
)
from tests.analysis.rows import trial_row

LABELS = ("PoLMDP", "optimal")


@pytest.fixture(scope="module")
def data(paper_fixture):
    """The synthetic trials."""
    return read_dataset(paper_fixture)


@pytest.fixture(scope="module")
def block(data):
    """Their statistics."""
    return as_in_paper(data)


def correct(block):
    return figure_correct(list(block.correct.arms.values()), LABELS)


def prediction_time(block):
    return figure_prediction_time(list(block.prediction_time.arms.values()), LABELS)


def axes_of(drawn):
    (axes,) = drawn.figure.axes
    return axes


def interval_of(axes):
    """Lower and upper end of each error bar, and each bar's height."""
    ends = [tuple(segment[:, 1]) for segment in axes.collections[0].get_segments()]
    return ends, [bar.get_height() for bar in axes.patches]


def test_correct_guesses_are_shown_from_0_to_100_percent(block):
    axes = axes_of(correct(block))
    assert axes.get_ylim() == (0, 100)
    assert axes.get_ylabel() == "Correct guesses, %"


def test_correct_guesses_stand_with_their_interval(block):
    ends, heights = interval_of(axes_of(correct(block)))
    shares = list(block.correct.arms.values())
    assert heights == pytest.approx([100 * each.share for each in shares])
    for (low, high), each in zip(ends, shares, strict=True):
        assert (low, high) == pytest.approx((100 * each.low, 100 * each.high))


def test_time_starts_at_zero_and_has_room_for_the_interval(block):
    axes = axes_of(prediction_time(block))
    low, high = axes.get_ylim()
    assert low == 0
    assert high > max(each.high for each in block.prediction_time.arms.values())
    assert axes.get_ylabel() == "Time of prediction, s"


def test_mean_times_stand_with_their_interval(block):
    ends, heights = interval_of(axes_of(prediction_time(block)))
    means = list(block.prediction_time.arms.values())
    assert heights == pytest.approx([each.mean for each in means])
    for (low, high), each in zip(ends, means, strict=True):
        assert (low, high) == pytest.approx((each.low, each.high))


def test_confidence_shows_the_whole_scale():
    axes = axes_of(figure_confidence([np.array([6.0, 7.0]), np.array([5.0, np.nan])], LABELS))
    assert list(axes.get_yticks()) == [1, 2, 3, 4, 5, 6, 7]
    assert [label.get_text() for label in axes.get_xticklabels()] == [
        "PoLMDP\nn = 2 trials",
        "optimal\nn = 1 trials",
    ]


def test_confidence_marks_the_mean_by_a_dot_and_the_median_by_a_thick_line(data):
    values = [values_of(data, arm, "confidence") for arm in CONDITIONS]
    axes = axes_of(figure_confidence(values, LABELS))
    dots = [
        float(line.get_ydata()[0])
        for line in axes.lines
        if line.get_marker() == "o" and line.get_markerfacecolor() == "white"
    ]
    thick = [float(line.get_ydata()[0]) for line in axes.lines if line.get_linewidth() > 3]
    assert dots == pytest.approx([each.mean() for each in values])
    assert thick == [np.median(each) for each in values]


def test_every_figure_says_how_many_trials_it_shows(block):
    for drawn in (correct(block), prediction_time(block)):
        labels = [label.get_text() for label in axes_of(drawn).get_xticklabels()]
        assert labels == ["PoLMDP\nn = 980 trials", "optimal\nn = 520 trials"]


def test_equal_values_far_out_are_one_ring():
    values = np.array([1.0] * 30 + [6.0] * 300 + [7.0] * 100)
    axes = axes_of(figure_confidence([values, values], LABELS))
    rings = [line for line in axes.lines if line.get_markeredgecolor() == "#777777"]
    assert [line.get_ydata().tolist() for line in rings] == [[1.0, 7.0], [1.0, 7.0]]


def test_confidence_on_another_scale_shows_that_scale():
    values = [np.array([1.0, 3.0]), np.array([5.0])]
    axes = axes_of(figure_confidence(values, LABELS, confidence_scale(1, 5)))
    assert list(axes.get_yticks()) == [1, 2, 3, 4, 5]
    assert axes.get_ylabel() == "Confidence, 1 to 5 (surest)"


def test_next_to_no_data_can_be_drawn(tmp_path):
    rows = [
        trial_row("P1", 1, "polmdp", stop_time_s=0.0),
        trial_row("P2", 1, "optimal", stop_time_s=0.0),
    ]
    block = as_in_paper(read_dataset(write_table(TRIALS, rows, tmp_path)[0]))
    write_figure(correct(block), tmp_path, "correct")
    write_figure(prediction_time(block), tmp_path, "time")
    assert (tmp_path / "correct.svg").stat().st_size > 0
    assert axes_of(prediction_time(block)).get_ylim() == (0, 1)


def test_a_single_trial_has_no_interval_in_words_and_in_data(tmp_path):
    rows = [trial_row("P1", 1, "polmdp"), trial_row("P2", 1, "optimal")]
    drawn = prediction_time(as_in_paper(read_dataset(write_table(TRIALS, rows, tmp_path)[0])))
    assert drawn.data["low_s"].to_list() == [None, None]
    assert "interval not defined" in drawn.alt


def test_the_paper_s_numbers_are_told_to_who_does_not_see_them(data, block):
    assert "PoLMDP 84.9 % (95 % interval 82.5 to 87.0 %, n = 980 trials)" in correct(block).alt
    assert "optimal 18.22 s (95 % interval 17.77 to 18.67 s" in prediction_time(block).alt
    values = [values_of(data, arm, "confidence") for arm in CONDITIONS]
    assert "PoLMDP mean 6.08, median 7" in figure_confidence(values, LABELS).alt
