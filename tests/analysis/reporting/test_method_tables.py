"""What the tables of methods say of the methods in them."""

from analysis import TRIALS, analyse_path, write_table
from analysis.reporting.drawings import drawings
from analysis.reporting.markdown import markdown
from analysis.reporting.method_tables import method_parts
from tests.analysis.rows import trial_row


def text_of(results, measure):
    return markdown(method_parts(results.evidence.comparisons[measure], 0.05))


def test_clustered_methods_are_said_to_count_with_trials_that_resemble_each_other(paper):
    assert (
        "Correct guesses, taking into account that trials of one participant resemble each other"
    ) in text_of(paper, "correct")


def test_the_mixed_model_is_told_as_an_odds_ratio_and_as_the_difference_that_forests_show(paper):
    told = text_of(paper, "correct")
    assert "| Crossed logistic mixed model | odds ratio 2.70 | 1.86 to 3.93 |" in told
    assert (
        "- Crossed logistic mixed model: the same in shares, as forests show it, "
        "difference = 15.2 percentage points, 95 % CI [9.4, 20.9]."
    ) in told
    forests = {each.name: each for each in drawings(paper.data, paper.evidence)}
    assert "mixed model 0.152 [0.094, 0.209]" in forests["forest_correct"].draw().alt


def test_a_model_without_an_estimate_has_no_difference_to_tell(tmp_path):
    rows = [trial_row("P1", 1, "polmdp"), trial_row("P2", 1, "optimal")]
    results = analyse_path(write_table(TRIALS, rows, tmp_path)[0])
    assert results.evidence.comparisons["correct"].results["crossed_logistic"].estimate is None
    assert "the same in shares" not in text_of(results, "correct")
