"""Participants dealt anew: R's numbers, all relabellings one by one, and what must not matter."""

import math
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis import EmptyArmError
from analysis.statistics.outcome import Outcome
from analysis.statistics.permutation import cluster_permutation
from tests.analysis.statistics.outcomes import of_fixture, outcome

SCORES = st.lists(st.integers(0, 7), min_size=2, max_size=8)


def permutation(data: Outcome, seed=1):
    return cluster_permutation(data, np.random.default_rng(seed))


def of_participants(values, treated) -> Outcome:
    """An outcome of one trial per participant."""
    there = np.arange(len(values))
    return outcome(values, there < treated, there, np.zeros(len(values)))


def test_golden_cluster_perm_exact_small(golden):
    """R combn enumeration."""
    case = golden("cluster_perm_exact_small")
    trials = case["input"]["trials"]
    found = permutation(
        outcome(
            trials["correct"],
            np.array(trials["condition"]) == "polmdp",
            trials["participant"],
            np.zeros(len(trials["correct"])),
        )
    )
    assert found.relabellings == case["expected"]["n_perm"]
    assert found.estimate == pytest.approx(case["expected"]["observed"], abs=case["tol"])
    assert found.p == pytest.approx(case["expected"]["p"], abs=case["tol"])
    assert (found.exact, found.of, found.n) == (True, "participants", 7)


def test_golden_perm_exact_confidence(golden, paper_fixture):
    """R exactRankTests::perm.test exact, on synthetic trials."""
    case = golden("perm_exact_confidence")
    found = permutation(of_fixture(paper_fixture, "confidence"))
    assert found.p == pytest.approx(case["expected"]["p"], abs=case["tol"])
    assert (found.exact, found.relabellings) == (True, math.comb(150, 52))
    assert (found.participants_treatment, found.participants_reference) == (98, 52)


@given(SCORES, st.data(), st.sampled_from([1, 0.7]))
def test_p_is_the_share_of_relabellings_at_least_as_far_apart(scores, data, unit):
    size = data.draw(st.integers(1, len(scores) - 1))
    values = np.array(scores)
    differences = [
        abs(values[list(arm)].mean() - np.delete(values, arm).mean())
        for arm in combinations(range(len(scores)), size)
    ]
    expected = np.mean(np.array(differences) >= differences[0] - 1e-9)
    found = permutation(of_participants(values * unit, size))
    assert found.p == pytest.approx(expected)
    assert (found.exact, found.relabellings) == (True, math.comb(len(scores), size))


def test_what_cannot_be_counted_is_drawn_and_says_so():
    rng = np.random.default_rng(3)
    data = of_participants(rng.normal(size=40) + np.repeat([0.5, 0], 20), 20)
    found = permutation(data)
    assert (found.exact, found.relabellings) == (False, 9_999)
    assert "Monte Carlo of 9,999 draws" in found.method
    assert found == permutation(data)
    assert found.p != permutation(data, seed=2).p
    assert found.p == pytest.approx(permutation(data, seed=2).p, abs=0.02)


def test_draws_estimate_the_exact_p(paper_fixture, monkeypatch):
    data = of_fixture(paper_fixture, "confidence")
    exact = permutation(data)
    monkeypatch.setattr("analysis.statistics.subset_sums.feasible", lambda *_: False)
    drawn = permutation(data)
    assert (exact.exact, drawn.exact) == (True, False)
    assert drawn.p == pytest.approx(exact.p, abs=4 * math.sqrt(exact.p / 9_999))


def test_no_draw_gives_a_p_of_zero():
    data = of_participants(np.arange(60) * math.pi, 30)
    assert permutation(data).p == 1 / 10_000


@given(SCORES, st.integers(2, 4))
def test_repeating_every_trial_changes_nothing(scores, times):
    size = len(scores) // 2
    there = np.arange(len(scores))
    repeated = outcome(
        np.repeat(scores, times),
        np.repeat(there < size, times),
        np.repeat(there, times),
        np.zeros(len(scores) * times),
    )
    assert permutation(repeated).p == permutation(of_participants(scores, size)).p


@given(SCORES)
def test_swapping_the_arms_flips_the_sign_and_keeps_p(scores):
    size = len(scores) // 2
    there = np.arange(len(scores))
    one = permutation(of_participants(scores, size))
    other = permutation(outcome(scores, there >= size, there, np.zeros(len(scores))))
    assert other.p == one.p
    assert other.estimate == pytest.approx(-(one.estimate or 0))


def test_values_that_are_all_equal_give_p_1_and_a_warning():
    found = permutation(of_participants([0.3] * 6, 3))
    assert (found.p, found.estimate, found.warnings) == (1, 0, ("constant_outcome",))


def test_missing_trials_are_left_out_and_counted():
    nan = float("nan")
    found = permutation(of_participants([1, nan, 3, 2, 5, nan], 3))
    assert (found.n, found.n_missing) == (4, 2)
    assert found.estimate == -1.5


def test_an_arm_without_values_is_a_structured_error():
    with pytest.raises(EmptyArmError):
        permutation(of_participants([float("nan"), 1.0], 1))
