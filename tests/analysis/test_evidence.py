"""What is set against what in the numbers of a whole analysis."""

import pytest


@pytest.mark.parametrize(
    ("measure", "effect", "of_ranks"),
    [("correct", 1.52, False), ("prediction_time_s", 1.73, True), ("confidence", 3.30, True)],
)
def test_the_papers_tests_are_set_against_the_likeness_of_what_they_compare(
    paper, measure, effect, of_ranks
):
    """Effects: variances by statsmodels, clustered over independent, of values or scipy's ranks."""
    found = paper.evidence.likeness[measure]
    assert found.design_effect == pytest.approx(effect, rel=0.05)
    assert found.correlation.method.endswith("of mid-ranks") is of_ranks
