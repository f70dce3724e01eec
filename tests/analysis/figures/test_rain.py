"""Rainclouds show participants, not trials, and thin their dots without changing their shape."""

import numpy as np
import polars as pl
import pytest

from analysis import EmptyArmError
from analysis.figures import (
    CONFIDENCE,
    CORRECT,
    PREDICTION_TIME,
    confidence_scale,
    figure_raincloud,
)
from analysis.figures.rain import MOST_DOTS
from tests.analysis.figures.studies import LABELS, trials


def dots(drawn, marker):
    """Places along the measure of one arm's small marks."""
    (axes,) = drawn.figure.axes
    (line,) = (
        each
        for each in axes.lines
        if each.get_marker() == marker and each.get_markerfacecolor() != "white"
    )
    return np.sort(line.get_xdata())


def test_there_is_a_dot_a_participant_at_their_mean():
    study = trials(20)
    drawn = figure_raincloud(study, CORRECT, LABELS)
    treated = study.filter("treated").group_by("participant").agg(pl.col("correct").mean())
    assert dots(drawn, "o") == pytest.approx(np.sort(100 * treated["correct"].to_numpy()))
    assert len(dots(drawn, "s")) == 10


def test_the_data_are_the_participants_means_of_what_is_not_missing():
    study = pl.DataFrame(
        {
            "participant": ["a", "a", "b", "c"],
            "treated": [True, True, False, False],
            "confidence": [3, 6, 7, None],
        }
    )
    drawn = figure_raincloud(study, CONFIDENCE, LABELS)
    assert drawn.data.rows() == [("PoLMDP", "a", 2, 4.5), ("optimal", "b", 1, 7.0)]
    assert "optimal, mean 7.00, median 7.00, n = 1 participants" in drawn.alt


def test_an_arm_without_a_value_is_an_error_that_names_it():
    study = trials(4).with_columns(confidence=pl.when("treated").then("confidence").otherwise(None))
    with pytest.raises(EmptyArmError, match="optimal"):
        figure_raincloud(study, CONFIDENCE, LABELS)


def test_of_many_participants_some_are_drawn_evenly_through_the_ranks_and_the_figure_says_so():
    study = trials(2 * (3 * MOST_DOTS), per_participant=2)
    drawn = figure_raincloud(study, PREDICTION_TIME, LABELS)
    shown = dots(drawn, "o")
    everyone = drawn.data.filter(arm="PoLMDP")["mean"].to_numpy()
    assert len(shown) == MOST_DOTS
    assert (shown[0], shown[-1]) == (everyone.min(), everyone.max())
    thirds = [1 / 3, 2 / 3]
    assert np.quantile(shown, thirds) == pytest.approx(np.quantile(everyone, thirds), rel=0.01)
    assert "small marks: at most 500 participants an arm" in note(drawn)
    assert "small marks: each participant" in note(figure_raincloud(trials(20), CORRECT, LABELS))


def note(drawn):
    return drawn.figure.texts[0].get_text().replace("\n", " ")


def test_the_order_of_rows_changes_nothing():
    study = trials(12)
    turned = study.sample(fraction=1, shuffle=True, seed=2)
    first, second = (figure_raincloud(each, CONFIDENCE, LABELS) for each in (study, turned))
    assert first.data.equals(second.data)
    assert dots(first, "o").tolist() == dots(second, "o").tolist()


@pytest.mark.parametrize("scale", [CORRECT, CONFIDENCE, confidence_scale(0, 100)])
def test_bins_are_centred_on_both_ends_of_a_scale(scale):
    edges = scale.edges(0)
    low, high = scale.ends
    assert edges[:2].mean() == pytest.approx(low)
    assert edges[-2:].mean() == pytest.approx(high)


def test_every_participant_is_in_a_bin():
    study = trials(30)
    for scale in (CORRECT, CONFIDENCE, PREDICTION_TIME):
        means = figure_raincloud(study, scale, LABELS).data["mean"].to_numpy()
        assert np.histogram(means, scale.edges(means.max()))[0].sum() == 30
