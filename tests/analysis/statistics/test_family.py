"""Correcting several p values: R's numbers, and what Holm's procedure promises."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from statsmodels.stats.multitest import multipletests

from analysis.statistics.family import holm

FAMILIES = st.lists(st.none() | st.floats(0, 1), max_size=6)


def test_golden_holm(golden):
    """R p.adjust; a missing p stays missing and is not counted."""
    case = golden("holm")
    assert case["source"] == "R p.adjust"
    assert holm(case["input"]["p"]) == pytest.approx(case["expected"]["p_adj"], abs=case["tol"])


@pytest.mark.parametrize("family", [[0.2], [0.01, 0.04, 0.03], [0.5, 0.5, 0.6, 1.0], [0.0, 0.9]])
def test_it_is_that_of_statsmodels(family):
    assert holm(family) == pytest.approx(multipletests(family, method="holm")[1].tolist())


@given(FAMILIES)
def test_a_missing_p_changes_no_other(family):
    present = [p for p in family if p is not None]
    corrected = holm(family)
    assert [p is None for p in corrected] == [p is None for p in family]
    assert tuple(p for p in corrected if p is not None) == holm(present)


@given(st.lists(st.floats(0, 1), min_size=1, max_size=6))
def test_the_smallest_p_is_multiplied_by_their_number_and_the_order_is_kept(family):
    corrected = [p for p in holm(family) if p is not None]
    assert min(corrected) == pytest.approx(min(1, len(family) * min(family)))
    in_order = [p for _, p in sorted(zip(family, corrected, strict=True))]
    assert in_order == sorted(in_order)
