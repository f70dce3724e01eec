"""What a report hands to its figures."""

from dataclasses import replace

from analysis.reporting.drawings import drawings


def test_forests_tell_p_from_the_plans_alpha(paper):
    """That of confidence, .09092, is below this alpha; with three digits it would not be."""
    data = replace(paper.data, plan=replace(paper.data.plan, alpha=0.09095))
    forests = {each.name: each for each in drawings(data, paper.evidence)}
    assert "(primary) 0.546 [0.492, 0.600], p = .0909;" in forests["forest_confidence"].draw().alt
