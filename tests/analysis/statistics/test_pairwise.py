"""Any of all differences is found without making them all."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.statistics import pairwise
from analysis.statistics.pairwise import Pairwise

SEVENTHS = st.lists(st.integers(0, 30).map(lambda n: n / 7), min_size=1, max_size=25)


@pytest.mark.parametrize("listed", [1, 1_000_000])
def test_every_rank_is_that_of_the_sorted_differences(monkeypatch, listed):
    monkeypatch.setattr(pairwise, "_MOST_LISTED", listed)

    @given(SEVENTHS, SEVENTHS, st.data())
    def holds(x, y, data):
        differences = np.sort(np.subtract.outer(x, y), axis=None)
        rank = data.draw(st.integers(1, len(differences)))
        found = Pairwise.of(np.array(x), np.array(y)).smallest(rank)
        assert found == pytest.approx(differences[rank - 1], abs=1e-12)

    holds()


def test_the_median_of_ten_thousand_million_differences_is_that_of_a_grid():
    grid = np.arange(100_001.0)
    assert Pairwise.of(grid + 0.5, grid).smallest((100_001**2 + 1) // 2) == 0.5
