"""What each trial contributes to an estimate, and the variance that follows for clusters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .outcome import Clusters, Numbers, Outcome

ROUNDING = 1e-14
"""Variances below this share of those they are made from are zeros that rounding blurred."""


@dataclass(frozen=True, eq=False)
class Influence:
    """An estimate, and by how much each trial moves it: `h`, shape (N,), sums to 0 in each arm."""

    estimate: float
    h: Numbers


def of_mean(y: Numbers) -> Influence:
    """Mean of at least one value; `h` is exactly 0 where all values are equal."""
    shifted = y - y[0]
    mean = shifted.mean()
    return Influence(float(y[0] + mean), (shifted - mean) / len(y))


def of_difference(data: Outcome) -> Influence:
    """Mean of the treatment arm minus mean of the reference arm; every trial has a value."""
    treatment, reference = of_mean(data.y[data.treated]), of_mean(data.y[~data.treated])
    h = np.empty_like(data.y)
    h[data.treated], h[~data.treated] = treatment.h, -reference.h
    return Influence(treatment.estimate - reference.estimate, h)


def of_auc(data: Outcome) -> Influence:
    """Probability that a trial of the treatment arm has the larger value, ties half.

    Source: Obuchowski (1997), Biometrics 53, 567-578.
    """
    placed = placements(data)
    treatment, reference = of_mean(placed[data.treated]), of_mean(placed[~data.treated])
    h = np.empty_like(data.y)
    h[data.treated], h[~data.treated] = treatment.h, reference.h
    return Influence(treatment.estimate, h)


def placements(data: Outcome) -> Numbers:
    """Share of the other arm's trials that a trial beats (ties half), shape (N,).

    For trials of the reference arm: the share that beats it.
    """
    values, level = np.unique(data.y, return_inverse=True)
    treatment = np.bincount(level[data.treated], minlength=len(values))
    reference = np.bincount(level[~data.treated], minlength=len(values))
    beaten = (np.cumsum(reference) - reference / 2) / reference.sum()
    beating = 1 - (np.cumsum(treatment) - treatment / 2) / treatment.sum()
    placed: Numbers = np.where(data.treated, beaten[level], beating[level])
    return placed


def cluster_count(cluster: Clusters) -> int:
    """Return how many different clusters the trials come from."""
    return int(np.count_nonzero(np.bincount(cluster)))


def cluster_variance(h: Numbers, cluster: Clusters) -> float | None:
    """Return G/(G-1) times the sum over G clusters of (sum of h)^2; None if G < 2."""
    clusters = cluster_count(cluster)
    if clusters < 2:
        return None
    sums = np.bincount(cluster, h)
    squared = float(sums @ sums)
    return squared * clusters / (clusters - 1) if squared > ROUNDING * float(h @ h) else 0.0
