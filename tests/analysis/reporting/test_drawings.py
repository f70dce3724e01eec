"""What a report hands to its figures."""

from dataclasses import replace

import polars as pl
import pytest

from analysis.reporting.drawings import drawings


def test_forests_tell_p_from_the_plans_alpha(paper):
    """That of confidence, .09092, is below this alpha; with three digits it would not be."""
    data = replace(paper.data, plan=replace(paper.data.plan, alpha=0.09095))
    forests = {each.name: each for each in drawings(data, paper.evidence)}
    assert "(primary) 0.546 [0.492, 0.600], p = .0909;" in forests["forest_confidence"].draw().alt


def test_the_caption_of_incidence_has_the_shares_counted_of_all_trials(paper):
    stopped = pl.col("correct") & (pl.col("stop_time_s") < pl.col("length_s"))
    by_arm = paper.data.trials.group_by("treated").agg(100 * stopped.mean())
    counted = dict(by_arm.iter_rows())
    captions = {each.name: each.caption for each in drawings(paper.data, paper.evidence)}
    assert captions["incidence"] == (
        "Estimated share of trials that had come to a correct or a wrong stop by each time. "
        f"Counted, of all trials: {counted[True]:.1f} % with PoLMDP, {counted[False]:.1f} % with "
        "optimal ended in a correct stop."
    )


@pytest.mark.parametrize(("exported", "label"), [(True, "Motion seen, s"), (False, "Time, s")])
def test_only_of_an_export_the_axis_of_incidence_says_that_it_counts_motion(paper, exported, label):
    data = replace(paper.data, exported=exported)
    figures = {each.name: each for each in drawings(data, paper.evidence)}
    (axes,) = figures["incidence"].draw().figure.axes
    assert axes.get_xlabel() == label


def test_the_papers_figures_are_said_to_take_trials_as_independent(paper):
    captions = {each.name: each.caption for each in drawings(paper.data, paper.evidence)}
    for name in ("correct", "prediction_time", "confidence"):
        assert captions[name].endswith("as in the paper: trials taken as independent.")
