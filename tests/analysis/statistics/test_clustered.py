"""Clustered comparisons against frozen numbers of R, libraries and their own symmetries."""

from analysis.statistics.clustered import (
    clustered_auc,
    clustered_difference,
    two_way_auc,
    two_way_difference,
)
from tests.analysis.statistics.cases import closely, holds
from tests.analysis.statistics.outcomes import of_fixture


def test_golden_clustered_difference(golden, paper_fixture):
    """R survey 4.1 svyby and svymean, strata = arm, ids = participant; synthetic trials."""
    test = clustered_difference(of_fixture(paper_fixture, "correct"))
    holds(
        closely(golden("cluster_rd_fixture")),
        {
            "p1": test.mean_treatment,
            "p2": test.mean_reference,
            "rd": test.estimate,
            "se": test.se,
            "t": test.statistic,
            "df": test.df,
            "p": test.p,
            "ci": [test.low, test.high],
            "deff1": test.design_effect_treatment,
            "deff2": test.design_effect_reference,
        },
    )


def test_golden_clustered_auc(golden, paper_fixture):
    """R, naive pairwise kernel; synthetic trials."""
    test = clustered_auc(of_fixture(paper_fixture, "time"))
    holds(
        closely(golden("cluster_auc_time")),
        {
            "auc": test.estimate,
            "rank_biserial": test.rank_biserial,
            "se": test.se,
            "t": test.statistic,
            "df": test.df,
            "p": test.p,
            "ci": [test.low, test.high],
        },
    )


def test_golden_two_way_difference(golden, paper_fixture):
    """R sandwich::vcovCL, HC0 with cadjust; synthetic trials."""
    test = two_way_difference(of_fixture(paper_fixture, "correct"))
    holds(
        closely(golden("twoway_lpm_fixture")),
        {
            "rd": test.estimate,
            "se": test.se,
            "t": test.statistic,
            "df": test.df,
            "p": test.p,
        },
    )


def test_golden_two_way_auc(golden, paper_fixture):
    """A separate numpy implementation of the formula; synthetic trials."""
    test = two_way_auc(of_fixture(paper_fixture, "time"))
    holds(
        closely(golden("twoway_auc_time")),
        {
            "auc": test.estimate,
            "v_participant": test.v_participant,
            "v_scenario": test.v_scenario,
            "v_trial": test.v_trial,
            "se": test.se,
            "t": test.statistic,
            "df": test.df,
            "p": test.p,
            "ci": [test.low, test.high],
        },
    )
