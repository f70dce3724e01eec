"""The Rao-Scott chi-square against frozen numbers of R, and where it is not defined."""

from analysis.statistics.rao_scott import rao_scott
from tests.analysis.statistics.cases import closely, holds
from tests.analysis.statistics.outcomes import of_fixture


def test_golden_rao_scott(golden, paper_fixture):
    """R survey::svychisq, ids = participant; synthetic trials."""
    test = rao_scott(of_fixture(paper_fixture, "correct"))
    holds(
        closely(golden("rao_scott_fixture")),
        {
            "F": test.statistic,
            "df1": test.df[0],
            "df2": test.df[1],
            "p_F": test.p,
            "chi2_uncorrected": test.chi2,
            "p_chisq": test.p_chi2,
        },
    )
