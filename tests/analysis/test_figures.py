"""The figures show the numbers honestly: axes, intervals, medians, labels."""

import numpy as np
import pytest

from analysis import TRIALS, analyse_path, write_table
from analysis.as_in_paper import values_of
from analysis.contract import CONDITIONS
from analysis.figures import (
    COLOURS,
    figure_confidence,
    figure_correct,
    figure_prediction_time,
    save,
)
from tests.analysis.rows import trial_row


@pytest.fixture(scope="module")
def paper(paper_fixture):
    """Results of the synthetic trials."""
    return analyse_path(paper_fixture)


def axes_of(figure):
    (axes,) = figure.axes
    return axes


def interval_of(axes):
    """Lower and upper end of each error bar, and each bar's height."""
    ends = [tuple(segment[:, 1]) for segment in axes.collections[0].get_segments()]
    return ends, [bar.get_height() for bar in axes.patches]


def test_correct_guesses_are_shown_from_0_to_100_percent(paper):
    axes = axes_of(figure_correct(paper.block))
    assert axes.get_ylim() == (0, 100)
    assert axes.get_ylabel() == "Correct guesses, %"


def test_correct_guesses_stand_with_their_interval(paper):
    ends, heights = interval_of(axes_of(figure_correct(paper.block)))
    shares = list(paper.block.correct.arms.values())
    assert heights == pytest.approx([100 * each.share for each in shares])
    for (low, high), each in zip(ends, shares, strict=True):
        assert (low, high) == pytest.approx((100 * each.low, 100 * each.high))


def test_time_starts_at_zero_and_has_room_for_the_interval(paper):
    axes = axes_of(figure_prediction_time(paper.block))
    low, high = axes.get_ylim()
    assert low == 0
    assert high > max(each.high for each in paper.block.prediction_time.arms.values())
    assert axes.get_ylabel() == "Time of prediction, s"


def test_mean_times_stand_with_their_interval(paper):
    ends, heights = interval_of(axes_of(figure_prediction_time(paper.block)))
    means = list(paper.block.prediction_time.arms.values())
    assert heights == pytest.approx([each.mean for each in means])
    for (low, high), each in zip(ends, means, strict=True):
        assert (low, high) == pytest.approx((each.low, each.high))


def test_confidence_shows_the_whole_scale():
    axes = axes_of(figure_confidence([np.array([6.0, 7.0]), np.array([5.0, np.nan])]))
    assert list(axes.get_yticks()) == [1, 2, 3, 4, 5, 6, 7]
    assert [label.get_text() for label in axes.get_xticklabels()] == [
        "PoLMDP\nn = 2 trials",
        "Optimal\nn = 1 trials",
    ]


def test_confidence_marks_the_mean_by_a_dot_and_the_median_by_a_thick_line(paper):
    values = [values_of(paper.data, arm, "confidence") for arm in CONDITIONS]
    axes = axes_of(figure_confidence(values))
    dots = [
        float(line.get_ydata()[0])
        for line in axes.lines
        if line.get_marker() == "o" and line.get_markerfacecolor() == "white"
    ]
    thick = [float(line.get_ydata()[0]) for line in axes.lines if line.get_linewidth() > 3]
    assert dots == pytest.approx([each.mean() for each in values])
    assert thick == [np.median(each) for each in values]


def test_every_figure_says_how_many_trials_it_shows(paper):
    for figure in (figure_correct(paper.block), figure_prediction_time(paper.block)):
        labels = [label.get_text() for label in axes_of(figure).get_xticklabels()]
        assert labels == ["PoLMDP\nn = 980 trials", "Optimal\nn = 520 trials"]


def test_the_two_colours_differ_in_lightness_as_well():
    from matplotlib.colors import to_rgb

    lightness = [np.dot(to_rgb(each), (0.2126, 0.7152, 0.0722)) for each in COLOURS.values()]
    assert abs(lightness[0] - lightness[1]) > 0.2


def test_next_to_no_data_can_be_drawn(tmp_path):
    rows = [
        trial_row("P1", 1, "polmdp", stop_time_s=0.0),
        trial_row("P2", 1, "optimal", stop_time_s=0.0),
    ]
    block = analyse_path(write_table(TRIALS, rows, tmp_path)[0]).block
    save(figure_correct(block), tmp_path, "correct")
    save(figure_prediction_time(block), tmp_path, "time")
    assert (tmp_path / "correct.svg").stat().st_size > 0
    assert axes_of(figure_prediction_time(block)).get_ylim() == (0, 1)


def test_files_carry_no_date_and_drawing_leaves_no_style_behind(paper, tmp_path):
    import matplotlib

    before = dict(matplotlib.rcParams)
    save(figure_correct(paper.block), tmp_path, "correct")
    assert dict(matplotlib.rcParams) == before
    svg = (tmp_path / "correct.svg").read_text()
    assert "<dc:date>" not in svg
    assert b"Software" not in (tmp_path / "correct.png").read_bytes()
