"""Whether the times that a page sent can be: held to the server's clock, which no page can forge.

They flag and never refuse: an outbox that was offline delivers late and together, and says for how
long a message waited. To claim a longer wait gains nothing beyond time that truly passed, because
no motion is taken to have begun before the animation was given out.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise

TOLERANCE_S = 2.0
"""By so much longer one message may travel than the next one; slow networks resend after 1 s."""

SEEN_TOLERANCE_MS = 1.0
"""A stop may lie so far before what the page had reported as seen: it rounds both."""


@dataclass(frozen=True)
class TrialTimes:
    """An answered trial by the server's clock (`..._at`), and what its page says of times.

    `available_since` is when the server gave out the animation; None if that is not known.
    `played_waited_ms` is how long the page kept the message that the motion had begun; None if it
    does not say. `seen_ms` is the motion known to have been seen before the stop.
    """

    available_since: datetime | None
    played_at: datetime
    stopped_at: datetime
    answered_at: datetime
    lead_in_ms: float
    played_waited_ms: float | None
    seen_ms: float
    stop_time_ms: float

    @property
    def moments(self) -> tuple[datetime | None, ...]:
        """The server's times, in the order in which they happened."""
        return self.available_since, self.played_at, self.stopped_at, self.answered_at


def server_stretch_s(trial: TrialTimes) -> float | None:
    """The longest motion that the server's clock can confirm, s; None where it was set back."""
    longest = _confirmed_s(trial)
    return None if longest is None else max(0.0, longest)


def is_impossible(trial: TrialTimes) -> bool | None:
    """Whether the stop is later than it can be, or before what was seen; None: cannot be judged."""
    if trial.stop_time_ms < trial.seen_ms - SEEN_TOLERANCE_MS:
        return True
    longest = _confirmed_s(trial)
    return None if longest is None else trial.stop_time_ms / 1000 > longest + TOLERANCE_S


def are_impossible(trials: Sequence[TrialTimes]) -> bool | None:
    """Whether any of a participant's trials is impossible, or all together, lead-ins included.

    `trials` are all that were answered, in order; None where nothing can be judged.
    """
    judged = [is_impossible(trial) for trial in trials] + [_too_long_together(trials)]
    if True in judged:
        return True
    return False if False in judged else None


def _confirmed_s(trial: TrialTimes) -> float | None:
    """Time from the earliest moment at which the motion can have begun to the stop, s.

    Negative where the stop came before the lead-in can have ended.
    """
    since = trial.available_since
    if since is None or not since <= trial.played_at <= trial.stopped_at:
        return None
    available_s = (trial.stopped_at - since).total_seconds() - trial.lead_in_ms / 1000
    if trial.played_waited_ms is None:
        # It may have waited for as long as there was time.
        return available_s
    between_s = (trial.stopped_at - trial.played_at).total_seconds()
    return min(available_s, between_s + trial.played_waited_ms / 1000)


def _too_long_together(trials: Sequence[TrialTimes]) -> bool | None:
    moments = [moment for trial in trials for moment in trial.moments]
    known = [moment for moment in moments if moment is not None]
    in_order = all(before <= after for before, after in pairwise(known))
    if not known or len(known) < len(moments) or not in_order:
        return None
    watched_ms = sum(trial.lead_in_ms + trial.stop_time_ms for trial in trials)
    return watched_ms / 1000 > (known[-1] - known[0]).total_seconds() + TOLERANCE_S
