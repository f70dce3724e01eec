"""Every warning that a result can carry can be told to a reader."""

from analysis.statistics import codes
from analysis.warning_texts import WARNINGS


def test_every_code_has_its_text_and_no_other_has():
    declared = {value for name, value in vars(codes).items() if name.isupper()}
    assert set(WARNINGS) == declared


def test_texts_complete_a_sentence():
    for text in WARNINGS.values():
        assert text[0].islower()
        assert not text.endswith(".")
