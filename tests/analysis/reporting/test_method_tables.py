"""What the tables of methods say of the methods in them."""

from analysis.reporting.markdown import markdown
from analysis.reporting.method_tables import method_parts


def text_of(paper, measure):
    return markdown(method_parts(paper.evidence.comparisons[measure], 0.05))


def test_clustered_methods_are_said_to_count_with_trials_that_resemble_each_other(paper):
    assert (
        "Correct guesses, taking into account that trials of one participant resemble each other"
    ) in text_of(paper, "correct")
