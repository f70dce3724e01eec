"""Stacked confidence counts every rated guess once."""

import polars as pl
import pytest
from matplotlib.patches import Rectangle

from analysis.figures import confidence_scale, figure_confidence_levels
from tests.analysis.figures.studies import LABELS, trials


def rated(*rows):
    return pl.DataFrame(rows, ("treated", "correct", "confidence"), orient="row")


def test_counts_and_percentages_are_of_an_arms_right_or_wrong_guesses():
    drawn = figure_confidence_levels(
        rated((True, True, 7), (True, True, 7), (True, True, 1), (True, False, 4)), LABELS
    )
    some = drawn.data.filter(pl.col("trials") > 0)
    assert some.rows() == [
        ("PoLMDP", "right", "1", 1, pytest.approx(100 / 3)),
        ("PoLMDP", "right", "7", 2, pytest.approx(200 / 3)),
        ("PoLMDP", "wrong", "4", 1, pytest.approx(100)),
    ]
    assert "optimal: no right guess; optimal: no wrong guess" in drawn.alt
    assert "PoLMDP, wrong guesses: 0 % 5, 0 % 6, 0 % 7, n = 1 trials" in drawn.alt


def test_every_trial_is_in_one_part():
    study = trials(30)
    data = figure_confidence_levels(study, LABELS).data
    assert data["trials"].sum() == len(study)
    assert data.group_by("arm", "guess").agg(pl.col("percent").sum())["percent"].to_list() == (
        pytest.approx([100] * 4)
    )


def test_a_trial_without_guess_or_rating_is_left_out():
    drawn = figure_confidence_levels(
        rated((True, True, 7), (True, None, 7), (False, True, None), (False, True, 2)), LABELS
    )
    assert drawn.data["trials"].sum() == 2


def test_bars_end_at_100_percent_and_parts_follow_one_another():
    (axes,) = figure_confidence_levels(trials(30), LABELS).figure.axes
    ends: dict[float, float] = {}
    for bar in axes.patches:
        if isinstance(bar, Rectangle) and bar.get_height() > 0:
            row = round(bar.get_y(), 3)
            assert bar.get_x() == pytest.approx(ends.get(row, 0))
            ends[row] = bar.get_x() + bar.get_width()
    assert list(ends.values()) == pytest.approx([100] * 4)


def test_the_number_in_a_part_is_its_count():
    study = rated(*[(True, True, 7)] * 12, *[(False, False, 3)] * 5)
    (axes,) = figure_confidence_levels(study, LABELS).figure.axes
    assert {"12", "5"} <= {text.get_text() for text in axes.texts}


def test_another_scale_is_cut_into_seven_equal_parts_that_hold_their_upper_ends():
    study = rated((True, True, 0), (True, True, 10), (True, True, 15), (False, True, 70))
    data = figure_confidence_levels(study, LABELS, confidence_scale(0, 70)).data
    assert data.filter(pl.col("trials") > 0).select("confidence", "trials").rows() == [
        ("to 10", 2),
        ("to 20", 1),
        ("to 70", 1),
    ]
