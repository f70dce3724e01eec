"""Incidence and accuracy are drawn as the methods return them."""

import numpy as np
import pytest

from analysis.figures import figure_accuracy_by_time, figure_calibration, figure_incidence
from analysis.statistics.calibration import Accuracy, AccuracyBy
from analysis.statistics.survival import cumulative_incidence, stops
from tests.analysis.figures.studies import LABELS, texts


def incidence(participant=(0, 1, 2, 3, 4, 5, 6, 7)):
    return cumulative_incidence(
        stops(
            stop_time_s=np.array([2.0, 4.0, 6.0, 8.0, 1.0, 3.0, 8.0, 8.0]),
            length_s=np.full(8, 8.0),
            correct=np.array([1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.0]),
            treated=np.arange(8) < 4,
            participant=np.array(participant),
            scenario=np.zeros(8, dtype=np.int64),
        )
    )


def test_correct_stops_rise_in_the_arms_lines_and_wrong_ones_in_dots():
    (axes,) = figure_incidence(incidence(), LABELS).figure.axes
    ends = {
        line.get_label(): (line.get_linestyle(), np.asarray(line.get_ydata())[-1])
        for line in axes.lines
    }
    assert ends == {
        "PoLMDP: correct stops": ("-", pytest.approx(50)),
        "PoLMDP: wrong stops": (":", pytest.approx(25)),
        "optimal: correct stops": ("--", pytest.approx(25)),
        "optimal: wrong stops": (":", pytest.approx(25)),
    }


def test_bands_are_drawn_unless_an_arm_has_one_participant():
    (axes,) = figure_incidence(incidence(), LABELS).figure.axes
    assert len(axes.collections) == 2
    drawn = figure_incidence(incidence((0, 0, 0, 0, 1, 1, 1, 1)), LABELS)
    assert not drawn.figure.axes[0].collections
    assert drawn.data["low_percent"].null_count() == len(drawn.data)


def test_trials_at_risk_begin_with_all_of_an_arm():
    drawn = figure_incidence(incidence(), LABELS)
    start = drawn.data.filter(time_s=0.0, stop="correct")
    assert start.select("arm", "at_risk").rows() == [("PoLMDP", 4), ("optimal", 4)]
    assert "by 8.0 s: PoLMDP 50.0 % correct and 25.0 % wrong stops; optimal" in drawn.alt


def correct_stops(stop_time_s, length_s):
    """The same in both arms, a participant a trial."""
    n = len(stop_time_s)
    twice = np.tile(stop_time_s, 2), np.tile(length_s, 2)
    ends = stops(*twice, np.ones(2 * n), np.arange(2 * n) < n, np.arange(2 * n), np.arange(2 * n))
    return cumulative_incidence(ends)


def test_estimates_are_told_from_the_shares_counted_of_all_trials():
    """A trial watched to its end, 2 s, leaves three that all stop: estimated 100 %, counted 75."""
    drawn = figure_incidence(correct_stops([2.0, 3.0, 4.0, 5.0], [2.0, 9.0, 9.0, 9.0]), LABELS)
    note = " ".join(" ".join(text.get_text() for text in texts(drawn.figure)).split())
    assert "Estimated share of trials stopped by then; a trial watched to its end leaves" in note
    assert drawn.alt == (
        "Curves of the estimated share of trials stopped by each time, where a trial watched to "
        "its end leaves the count there; by 5.0 s: PoLMDP 100.0 % correct and 0.0 % wrong stops; "
        "optimal 100.0 % correct and 0.0 % wrong stops. Counted, of all trials, whenever they "
        "ended: PoLMDP 75.0 % correct and 0.0 % wrong stops, n = 4 trials; "
        "optimal 75.0 % correct and 0.0 % wrong stops, n = 4 trials."
    )


def test_the_axis_ends_where_fewer_than_ten_trials_of_an_arm_are_at_risk():
    """Of 12 that stop at 1, 2, .. 12 s, ten have not stopped before 3 s, and nine before 4 s."""
    drawn = figure_incidence(correct_stops(np.arange(1.0, 13), np.full(12, 20.0)), LABELS)
    (axes,) = drawn.figure.axes
    assert axes.get_xlim() == (0, 3)
    assert drawn.data["time_s"].unique().sort().to_list() == [0, 1, 2, 3]
    assert drawn.data["at_risk"].min() == 10
    assert "by 3.0 s: PoLMDP 25.0 % correct" in drawn.alt
    assert "Counted, of all trials, whenever they ended: PoLMDP 100.0 % correct" in drawn.alt


def accuracy(level, n, n_correct):
    return Accuracy(
        lower=level,
        upper=level,
        mean=level + 0.25 if n else None,
        n=n,
        n_correct=n_correct,
        n_participants=n,
        share=n_correct / n if n else None,
        low=0.1 if n > 1 else None,
        high=0.9 if n > 1 else None,
    )


BY = AccuracyBy(
    unit="scale points",
    treatment=(accuracy(1, 0, 0), accuracy(2, 4, 2), accuracy(3, 1, 1)),
    reference=(accuracy(1, 2, 0), accuracy(2, 0, 0), accuracy(3, 5, 4)),
    n=12,
    n_missing=0,
)


@pytest.mark.parametrize("draw", [figure_calibration, figure_accuracy_by_time])
def test_each_bin_with_trials_has_a_mark_and_one_with_an_interval_a_whisker(draw):
    (axes,) = draw(BY, LABELS, 1 / 6).figure.axes
    treatment, reference, chance = axes.lines
    assert treatment.get_ydata().tolist() == [50, 100]
    assert reference.get_ydata().tolist() == [0, 80]
    assert chance.get_ydata() == pytest.approx([100 / 6, 100 / 6])
    whiskers = [[tuple(each[:, 1]) for each in arm.get_segments()] for arm in axes.collections]
    assert whiskers == [[(10, 90)], [(10, 90), (10, 90)]]


def test_calibration_writes_the_trials_of_each_level_below_it():
    (axes,) = figure_calibration(BY, LABELS, 1 / 6).figure.axes
    written = [text.get_text() for text in axes.texts]
    assert written == ["Trials", "●", "0", "4", "1", "■", "2", "0", "5"]


def test_accuracy_by_time_stands_at_the_mean_time_of_its_trials():
    drawn = figure_accuracy_by_time(BY, LABELS, 1 / 6)
    assert np.asarray(drawn.figure.axes[0].lines[0].get_xdata()).tolist() == [2.25, 3.25]
    assert "PoLMDP 50 % at 2.25 s, 100 % at 3.25 s; optimal 0 % at 1.25 s" in drawn.alt
    assert "Guessing blindly gives 16.7 %." in drawn.alt
