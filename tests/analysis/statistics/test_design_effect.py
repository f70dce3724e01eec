"""How much clustering a verdict bears."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis.statistics.design_effect import design_effect, tipping_icc


@pytest.mark.parametrize("which", range(4))
def test_golden_tipping_icc(golden, which):
    """scipy chi2.ppf."""
    case = golden("tipping_icc")
    given_, expected = case["input"][which], case["expected"][which]
    found = tipping_icc(given_["stat"], given_["m"])
    assert found.design_effect_max == pytest.approx(expected["design_effect_max"], abs=case["tol"])
    assert found.icc_max == pytest.approx(expected["icc_max"], abs=case["tol"])
    assert found.robust_to_any_icc is expected["robust_to_any_icc"]


@given(st.floats(4, 30), st.floats(2, 20))
def test_at_the_tipping_icc_p_is_alpha(statistic, trials):
    found = tipping_icc(statistic, trials)
    assert found.icc_max is not None
    corrected = statistic / design_effect(found.icc_max, trials)
    assert stats.chi2.sf(corrected, 1) == pytest.approx(0.05)
    assert found.robust_to_any_icc == (found.icc_max > 1)


@pytest.mark.parametrize(("statistic", "significant"), [(3.0, False), (4.0, True)])
def test_single_trials_cannot_resemble_each_other(statistic, significant):
    found = tipping_icc(statistic, 1)
    assert (found.icc_max, found.robust_to_any_icc) == (None, significant)
