"""How many of each kind come."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.bots.kinds import DEFAULT_MIX, Kind, deal_kinds, read_mix
from app.errors import InvalidInput

mixes = st.dictionaries(st.sampled_from(Kind), st.floats(0.01, 100), min_size=1)


def test_a_mix_is_read_with_1_for_a_kind_without_a_share():
    mix = read_mix("attentive=8, guessing,two_tabs=0.5")
    assert mix == {Kind.ATTENTIVE: 8, Kind.GUESSING: 1, Kind.TWO_TABS: 0.5}


@pytest.mark.parametrize(
    "text", ["", "atentive=1", "attentive=many", "attentive=-1", "attentive=0", "attentive=nan"]
)
def test_a_mix_that_cannot_be_is_refused_in_one_line(text):
    with pytest.raises(InvalidInput, match="--mix: expected") as refusal:
        read_mix(text)
    assert "\n" not in str(refusal.value)


@given(mixes, st.integers(1, 300), st.integers(0, 2**32))
def test_every_kind_comes_as_often_as_its_share_to_less_than_one(mix, number, seed):
    kinds = deal_kinds(mix, number, np.random.default_rng(seed))
    assert len(kinds) == number
    for kind in Kind:
        share = number * mix.get(kind, 0) / sum(mix.values())
        assert abs(kinds.count(kind) - share) < 1


def test_the_usual_mix_has_every_kind():
    assert set(deal_kinds(read_mix(DEFAULT_MIX), 30, np.random.default_rng(1))) == set(Kind)
