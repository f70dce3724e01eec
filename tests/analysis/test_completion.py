"""Who finished: by the participants table, else by the plan's number of trials."""

import polars as pl
import pytest

from analysis.completion import completion


def done(found):
    return dict(found.people.select("participant", "done").iter_rows())


@pytest.fixture
def trials():
    """Ten trials of A, eleven of B, nine of C."""
    names = ["A"] * 10 + ["B"] * 11 + ["C"] * 9
    return pl.DataFrame({"participant": names}).with_columns(condition=pl.lit("polmdp"))


def test_whoever_has_the_plans_trials_finished_even_if_somebody_has_more(trials):
    found = completion(trials, None, planned=10)
    assert done(found) == {"A": True, "B": True, "C": False}
    assert found.finished == "answered the plan's 10 trials"
    assert found.incomplete == "fewer than the plan's 10 trials"


def test_where_nobody_has_the_plans_trials_those_with_most_finished(trials):
    found = completion(trials, None, planned=20)
    assert done(found) == {"A": False, "B": True, "C": False}
    assert found.finished == "answered as many trials as anyone"
    assert found.incomplete == "fewer than 11 trials, the most that anyone has"


def test_the_participants_table_decides_whatever_the_number_of_trials(trials):
    people = pl.DataFrame(
        {"participant": ["A", "B", "C", "D"], "status": ["trials", "withdrawn", *["completed"] * 2]}
    )
    found = completion(trials, people, planned=10)
    assert done(found) == {"A": False, "B": False, "C": True}
    assert (found.finished, found.incomplete) == ("completed the study", "study not completed")
