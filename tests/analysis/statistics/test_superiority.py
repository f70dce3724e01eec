"""The probability of superiority against beta posteriors, R's integrals and its own symmetries."""

import numpy as np
import pytest
from scipy import integrate, stats

from analysis import EmptyArmError
from analysis.statistics.outcome import Outcome
from analysis.statistics.superiority import superiority


def counted(treatment, reference):
    """Trials of participants who have (right, trials) each."""
    people = [*treatment, *reference]
    y = np.concatenate([np.repeat([1.0, 0.0], [right, n - right]) for right, n in people])
    participant = np.repeat(np.arange(len(people)), [n for _, n in people])
    return Outcome(
        "correct", "share", y, participant < len(treatment), participant, np.arange(len(y))
    )


SMALL = [(9, 10), (7, 10), (10, 10), (8, 10), (6, 9)], [(5, 10), (8, 10), (7, 10), (9, 10)]


def test_it_is_rs_integral():
    """R 4.2.2; a posterior density up to its constant, for counts k of n.

    lik <- function(mu, rho, k, n) sapply(rho, function(r) {
      a <- mu * (1 - r) / r; b <- (1 - mu) * (1 - r) / r
      exp(sum(lbeta(k + a, n - k + b) - lbeta(a, b))) })
    post <- function(mu, k, n) sapply(mu, function(m) integrate(function(r)
      lik(m, r, k, n) * 1e30, 1e-9, 1 - 1e-9, rel.tol = 1e-9, subdivisions = 2000)$value)
    zT <- integrate(function(m) post(m, kt, nt), 0, 1, rel.tol = 1e-8)$value   # zR alike
    cdfR <- function(m) sapply(m, function(u)
      integrate(function(v) post(v, kr, nr), 0, u, rel.tol = 1e-8)$value / zR)
    integrate(function(m) post(m, kt, nt) / zT * cdfR(m), 0, 1, rel.tol = 1e-7)$value
    integrate(function(m) m * post(m, kt, nt) / zT, 0, 1, rel.tol = 1e-8)$value
    # correlations: mu and rho change places
    """
    found = superiority(counted(*SMALL))
    assert found.probability == pytest.approx(0.7301818024, abs=1e-6)
    assert found.share_treatment == pytest.approx(0.7607193208, abs=1e-6)
    assert found.share_reference == pytest.approx(0.6768592869, abs=1e-6)
    assert found.correlation_treatment == pytest.approx(0.1819916993, abs=1e-6)
    assert found.correlation_reference == pytest.approx(0.1726122895, abs=1e-6)
    assert (found.participants_treatment, found.participants_reference) == (5, 4)


@pytest.mark.parametrize(
    ("treatment", "reference"),
    [
        ((7, 10), (4, 12)),
        ((30, 30), (25, 28)),
        ((0, 5), (5, 5)),
        ((700, 1000), (680, 1000)),
        ((3, 4), (6900, 10_000)),
    ],
)
def test_with_one_trial_each_the_posteriors_are_plain_betas(treatment, reference):
    """Nothing is told of the correlation: beta(1 + right, 1 + wrong), by scipy."""

    def once_each(right, n):
        return [(1, 1)] * right + [(0, 1)] * (n - right)

    found = superiority(counted(once_each(*treatment), once_each(*reference)))
    one, other = (stats.beta(1 + k, 1 + n - k) for k, n in (treatment, reference))
    expected = integrate.quad(lambda mu: one.pdf(mu) * other.cdf(mu), 0, 1, points=[one.mean()])[0]
    assert found.probability == pytest.approx(expected, abs=1e-7)
    assert found.share_treatment == pytest.approx(one.mean(), abs=1e-7)
    assert found.correlation_reference == pytest.approx(0.5, abs=1e-7)


def test_swapping_the_arms_gives_the_rest():
    one, other = superiority(counted(*SMALL)), superiority(counted(*SMALL[::-1]))
    assert one.probability + other.probability == pytest.approx(1, abs=1e-7)
    assert one.share_treatment == other.share_reference


def test_the_same_counts_are_as_probable_either_way():
    assert superiority(counted(SMALL[0], SMALL[0])).probability == pytest.approx(0.5, abs=1e-7)


def test_trials_that_resemble_each_other_make_it_less_certain():
    """The same shares, of participants who are all alike or all right or all wrong."""
    alike = superiority(counted([(8, 10)] * 10, [(5, 10)] * 10))
    unlike = superiority(counted([(10, 10)] * 8 + [(0, 10)] * 2, [(10, 10), (0, 10)] * 5))
    assert alike.probability > 0.99 > 0.95 > unlike.probability
    assert alike.correlation_treatment < 0.1 < 0.6 < unlike.correlation_treatment


def test_missing_guesses_are_left_out():
    data = counted(*SMALL)
    y = np.append(data.y, np.nan)
    more = Outcome(
        "correct",
        "share",
        y,
        np.append(data.treated, False),
        np.append(data.participant, 8),
        np.arange(len(y)),
    )
    assert superiority(more) == superiority(data)


def test_an_empty_arm_is_a_structured_error():
    with pytest.raises(EmptyArmError, match="condition reference"):
        superiority(counted(SMALL[0], []))
