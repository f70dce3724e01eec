"""What a row of the participants table must not say of itself."""

import pytest

from analysis import TableError, read_dataset
from tests.analysis.rows import edited


@pytest.mark.parametrize(
    ("edits", "column", "words"),
    [
        (
            {"too_fast_trials": "4"},
            "too_fast_trials",
            "no more than trials_answered, got too_fast_trials 4, trials_answered 3",
        ),
        (
            {"trials_answered": "0"},
            "never_moved_pointer",
            "nothing with trials_answered below 1, got never_moved_pointer false",
        ),
        (
            {"trials_answered": "1"},
            "same_guess",
            "nothing with trials_answered below 2, got same_guess false, trials_answered 1",
        ),
        (
            {"trials_answered": "1", "same_guess": "", "same_confidence": "true"},
            "same_confidence",
            "nothing with trials_answered below 2, got same_confidence true",
        ),
        (
            {"status": "trials", "trials_s": "240.5"},
            "trials_s",
            "nothing unless status is completed, got trials_s 240.5, status 'trials'",
        ),
        ({"same_guess": "sometimes"}, "same_guess", "expected true or false, got 'sometimes'"),
    ],
)
def test_a_contradiction_is_named_by_row_and_column(export, edits, column, words):
    for name, text in edits.items():
        edited(export / "participants.csv", 3, name, text)
    with pytest.raises(TableError) as caught:
        read_dataset(export)
    error = caught.value
    assert (error.file, error.row, error.column) == ("participants.csv", 3, column)
    assert words in str(error)


def test_who_has_answered_nothing_yet_contradicts_nothing(export):
    nothing_yet = {
        "trials_answered": "0",
        "never_moved_pointer": "",
        "same_guess": "",
        "same_confidence": "",
        "practice_s": "",
        "trials_s": "",
        "status": "practice",
    }
    for name, text in nothing_yet.items():
        edited(export / "participants.csv", 2, name, text)
    assert read_dataset(export).participants is not None
