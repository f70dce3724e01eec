"""The degrees of freedom of Student's t where trials are clustered: one rule for every test."""

from __future__ import annotations

from .influence import cluster_count, cluster_variance
from .outcome import UNKNOWN, Numbers, Outcome

ONE_WAY_DF = "t on Welch's df over the arms, or participants - 1 where somebody is in both"
"""What the method of a result says of `by_participant`."""
TWO_WAY_DF = "t on the smaller of scenarios - 1 and the participants' df"
"""What it says of `by_participant_and_scenario`."""


def participants_of_arms(data: Outcome) -> list[int]:
    """Return the numbers of participants of the arms that have trials, the treatment's first."""
    arms = (data.treated, ~data.treated)
    return [cluster_count(data.participant[arm]) for arm in arms if arm.any()]


def within_participants(data: Outcome) -> bool:
    """Tell whether somebody has trials in both arms."""
    return sum(participants_of_arms(data)) > cluster_count(data.participant)


def by_participant(data: Outcome, h: Numbers) -> float:
    """Return the degrees of freedom of sums of influence `h`, shape (N,), over participants.

    Different participants in the arms: Welch's, as the arms share in the variance. Somebody in both
    arms: the participants less one of the arm with fewer, which is Student's paired t where all are
    in both and the least that Welch's could be where few are. One arm: its participants less one.
    Each arm has at least two. Source: Satterthwaite (1946), Biometrics Bulletin 2, 110-114.
    """
    counts = participants_of_arms(data)
    least = min(counts) - 1
    if len(counts) == 1 or within_participants(data):
        return least
    arms = (data.treated, ~data.treated)
    variances = [cluster_variance(h[arm], data.participant[arm]) or 0.0 for arm in arms]
    spread = sum(v**2 / (n - 1) for v, n in zip(variances, counts, strict=True))
    return sum(variances) ** 2 / spread if spread else least


def by_participant_and_scenario(data: Outcome, h: Numbers) -> float:
    """Return the degrees of freedom of sums of `h` over participants and over scenarios.

    The smaller of `by_participant` and scenarios less one; without a known scenario the former.
    """
    of_participants = by_participant(data, h)
    scenarios = cluster_count(data.scenario[data.scenario != UNKNOWN])
    return min(of_participants, scenarios - 1) if scenarios else of_participants
