"""A forest shows comparable results only, and marks the primary one."""

import pytest

from analysis import AnalysisError
from analysis.figures import figure_forest
from analysis.statistics.result import TestResult
from tests.analysis.figures.studies import LABELS


def result(estimate, low, high, *, p: float | None = 0.04996, unit="share", null=0.0):
    return TestResult(
        estimate=estimate,
        low=low,
        high=high,
        null=null,
        unit=unit,
        symbol="t",
        statistic=None,
        df=None,
        p=p,
        n=1500,
        n_missing=0,
        method="a method",
        source="a source",
    )


BOTH = {"two-way": result(0.153, 0.081, 0.225), "on trials": result(0.153, 0.11, 0.196, p=1e-9)}


def forest(results, primary="two-way", alpha=0.05):
    return figure_forest(results, primary, "Difference in correct guesses", LABELS, alpha)


def written(drawn):
    (axes,) = drawn.figure.axes
    return [text.get_text() for text in axes.texts]


def test_estimates_stand_with_their_interval_and_p():
    assert written(forest(BOTH)) == [
        "0.153 [0.081, 0.225]\np = .04996",
        "0.153 [0.110, 0.196]\np < .001",
    ]


def test_intervals_are_drawn_from_low_to_high():
    (axes,) = forest(BOTH).figure.axes
    bars = [tuple(line.get_xdata()) for line in axes.lines if len(line.get_xdata()) == 2]
    assert bars == [(0, 0), (0.081, 0.225), (0.11, 0.196)]


def test_the_primary_method_alone_is_bold_and_a_diamond():
    (axes,) = forest(BOTH).figure.axes
    weights = {label.get_text(): label.get_fontweight() for label in axes.get_yticklabels()}
    assert weights == {"two-way": "bold", "on trials": "normal"}
    assert [line.get_marker() for line in axes.lines].count("D") == 1
    assert forest(BOTH).data["primary"].to_list() == [True, False]


def test_without_the_primary_method_none_is_marked_nor_explained():
    drawn = forest(BOTH, primary="another")
    assert not drawn.data["primary"].any()
    assert "Diamond" not in drawn.figure.texts[0].get_text()


def test_a_result_without_interval_or_estimate_says_so():
    drawn = forest(
        {"two-way": result(0.153, None, None), "mixed": result(None, None, None, p=None)}
    )
    assert written(drawn) == ["0.153, no interval\np = .04996", "not defined"]
    assert "mixed not defined, no test" in drawn.alt


def test_an_estimate_without_a_test_has_no_p():
    drawn = forest({**BOTH, "Newcombe": result(0.153, 0.108, 0.199, p=None)})
    assert written(drawn)[2] == "0.153 [0.108, 0.199]"
    assert drawn.alt.endswith("Newcombe 0.153 [0.108, 0.199], no test.")
    assert "NA" not in drawn.alt


@pytest.mark.parametrize(("alpha", "shown"), [(0.01, "p = .0098"), (0.05, "p = .010")])
def test_p_falls_on_its_side_of_the_plans_alpha(alpha, shown):
    drawn = forest({"two-way": result(0.1, 0.0, 0.2, p=0.0098)}, alpha=alpha)
    assert written(drawn)[0].endswith(f"\n{shown}")
    assert drawn.alt.endswith(f", {shown}.")


@pytest.mark.parametrize("other", [{"unit": "probability"}, {"null": 0.5}])
def test_results_of_different_units_or_null_values_are_refused(other):
    with pytest.raises(AnalysisError, match="one unit and one null value, got share, null 0"):
        forest({"two-way": result(0.1, 0, 0.2), "other": result(0.6, 0.5, 0.7, **other)})


def test_bounds_next_to_0_have_no_sign():
    assert written(forest({"two-way": result(0.1, -1e-9, 0.2)}))[0].startswith("0.100 [0.000, 0.2")


def test_no_result_is_refused():
    with pytest.raises(AnalysisError, match="got no result"):
        forest({})


def test_ratios_stand_on_a_logarithmic_axis_with_plain_numbers():
    drawn = forest({"two-way": result(2.4, 1.2, 4.8, unit="odds ratio", null=1.0)})
    (axes,) = drawn.figure.axes
    assert axes.get_xscale() == "log"
    drawn.figure.draw_without_rendering()
    assert {"1", "2", "5"} <= {label.get_text() for label in axes.get_xticklabels()}


@pytest.mark.parametrize(
    ("estimate", "shown"),
    [
        (0.0153, "0.0153"),
        (2.5512, "2.55"),
        (15.31, "15.3"),
        (0.0, "0.00"),
        (1e-17, "0.0000"),
        (-1e-17, "0.0000"),
    ],
)
def test_estimates_have_three_digits(estimate, shown):
    drawn = forest({"two-way": result(estimate, estimate - 1, estimate + 1)})
    assert written(drawn)[0].startswith(f"{shown} [")
