"""A table without some number says why; one with all of them says nothing."""

import re

import pytest

from analysis.reporting.document import NOTHING, Grid, Paragraph, with_reason
from analysis.reporting.markdown import markdown
from analysis.reporting.report import report_parts


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
