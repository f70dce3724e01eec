"""A table without some number says why; one with all of them says nothing."""

import re
from itertools import pairwise

import pytest

from analysis import TRIALS, analyse_path, write_table
from analysis.reporting.document import NOTHING, Grid, Paragraph, with_reason
from analysis.reporting.markdown import markdown
from analysis.reporting.plain import plain_text
from analysis.reporting.report import brief_parts, report_parts
from tests.analysis.rows import trial_row


@pytest.mark.parametrize("cell", [NOTHING, f"30.0 ({NOTHING})"])
def test_a_table_that_lacks_a_number_says_why_below_itself(cell):
    grid = Grid("A table", ("", "mean"), (("an arm", cell), ("another", "2.0")))
    assert with_reason(grid, "nobody told") == [grid, Paragraph(f"{NOTHING}: nobody told.")]


def test_a_table_with_all_numbers_stands_alone_whatever_its_rows_are_called():
    grid = Grid("A table", ("", "mean"), ((f"slow {NOTHING} fast", "1.0"), ("another", "2.0")))
    assert with_reason(grid, "nobody told") == [grid]


def test_methods_without_an_interval_have_a_dash_which_is_explained(paper):
    text = markdown(report_parts(paper))
    assert re.search(r"\| Fisher's exact test \| odds ratio [\d.]+ \| – \|", text)
    assert text.count("–: the method gives none, or a note below says why there is none.") == 6


def test_one_trial_an_arm_leaves_no_table_with_na_and_no_dash_unexplained(tmp_path):
    rows = [trial_row("P1", 1, "polmdp"), trial_row("P2", 1, "optimal")]
    results = analyse_path(write_table(TRIALS, rows, tmp_path)[0])
    parts = report_parts(results)
    for grid, below in pairwise(parts):
        if not isinstance(grid, Grid):
            continue
        cells = [cell for row in grid.rows for cell in row]
        assert not [cell for cell in cells if "NA" in cell], grid.caption
        if NOTHING in cells:
            assert isinstance(below, Paragraph), grid.caption
            assert below.text.startswith(f"{NOTHING}: "), grid.caption
    assert plain_text(brief_parts(results)).isascii()
