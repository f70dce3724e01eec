"""Scenario slopes pair a scenario with itself and say what they leave out."""

import polars as pl
import pytest

from analysis.figures import CONFIDENCE, CORRECT, figure_slopes
from tests.analysis.figures.studies import LABELS, trials


def three_scenarios():
    """One scenario better with each arm, one equal, one seen in the treatment only."""
    rows = [
        ("s1", True, True),
        ("s1", False, False),
        ("s2", True, False),
        ("s2", True, True),
        ("s2", False, True),
        ("s3", True, True),
        ("s3", False, True),
        ("s4", True, True),
    ]
    return pl.DataFrame(rows, ("scenario", "treated", "correct"), orient="row")


def legend(drawn):
    return [text.get_text() for text in drawn.figure.legends[0].get_texts()]


def test_lines_are_counted_by_direction():
    assert legend(figure_slopes(three_scenarios(), CORRECT, LABELS)) == [
        "higher with PoLMDP: 1 of 3 scenarios",
        "higher with optimal: 1 of 3 scenarios",
        "equal: 1 of 3 scenarios",
        "mean of the scenarios",
    ]


def test_the_data_hold_both_means_of_each_shared_scenario():
    data = figure_slopes(three_scenarios(), CORRECT, LABELS).data
    assert data.select("scenario", "reference", "treatment", "difference").rows() == [
        ("s1", 0, 100, 100),
        ("s2", 100, 50, -50),
        ("s3", 100, 100, 0),
    ]
    assert data.select("n_reference", "n_treatment").rows() == [(1, 1), (1, 2), (1, 1)]


def test_scenarios_of_one_arm_are_left_out_and_counted():
    drawn = figure_slopes(three_scenarios(), CORRECT, LABELS)
    left_out = "1 scenario seen in one arm only left out."
    assert left_out in drawn.figure.texts[0].get_text().replace("\n", " ")
    assert left_out in drawn.alt
    assert "left out" not in figure_slopes(trials(40), CONFIDENCE, LABELS).alt


def test_the_bold_line_joins_the_means_over_scenarios_each_counted_once():
    drawn = figure_slopes(three_scenarios(), CORRECT, LABELS)
    (axes,) = drawn.figure.axes
    (bold,) = (line for line in axes.lines if line.get_linewidth() > 3)
    assert bold.get_ydata() == pytest.approx((200 / 3, 250 / 3))
    assert "66.7 % with optimal, 83.3 % with PoLMDP" in drawn.alt


def test_without_a_shared_scenario_nothing_is_drawn_and_the_figure_says_why():
    drawn = figure_slopes(three_scenarios().filter(scenario="s4"), CORRECT, LABELS)
    assert drawn.data.is_empty()
    assert drawn.alt.startswith("No scenario has values in both arms.")
    assert legend(drawn)[0] == "higher with PoLMDP: 0 of 0 scenarios"


def test_a_missing_value_is_not_part_of_a_mean():
    study = pl.DataFrame(
        {
            "scenario": ["s1"] * 3,
            "treated": [True, True, False],
            "confidence": [3, None, 4],
        }
    )
    data = figure_slopes(study, CONFIDENCE, LABELS).data
    assert data.select("treatment", "reference", "n_treatment").rows() == [(3, 4, 1)]
