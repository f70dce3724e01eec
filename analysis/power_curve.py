"""Power as a smooth function of the number of participants, from a few simulated numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from .simulated_studies import ALPHA
from .statistics.estimates import Share

_FAINTEST = 0.1
"""Smallest shift of the statistic, in standard errors, that is told from none."""


@dataclass(frozen=True)
class PowerCurve:
    """Power with N participants is Phi(1 / sqrt(`floor` + `slope` / N) - critical value of t).

    The variance of an estimate has a part that more participants lower, and one that only more
    scenarios would; `floor` and `slope` are both, over the effect's square. t has the smaller of
    `scenarios` - 1 and N - 2 degrees of freedom, as in arms that vary alike.
    """

    floor: float
    slope: float
    scenarios: int

    def at(self, participants: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the power with each number of participants."""
        from scipy.special import ndtr

        shift = 1 / np.sqrt(self.floor + self.slope / participants)
        power: NDArray[np.float64] = ndtr(shift - _critical(participants, self.scenarios))
        return power

    def needed(self, power: float) -> int | None:
        """Smallest even number of participants with the power; None if no number has it."""
        from scipy.special import ndtri

        critical = float(_critical(np.array([np.inf]), self.scenarios)[0])
        room = (float(ndtri(power)) + critical) ** -2 - self.floor
        if room <= 0:
            return None
        number = max(2, 2 * ceil(self.slope / room / 2))
        # no number below has it; some more may be needed where they, not scenarios, are few
        while self.at(np.array([number]))[0] < power:
            number += 2
        return number


def _critical(participants: NDArray[np.float64], scenarios: int) -> NDArray[np.float64]:
    from scipy.special import stdtrit

    df = np.clip(participants - 2, 1, scenarios - 1)
    return np.asarray(stdtrit(df, 1 - ALPHA / 2), dtype=np.float64)


def fit_power(participants: Sequence[int], power: Sequence[Share], scenarios: int) -> PowerCurve:
    """Fit the curve to simulated power by weighted least squares, weights by Monte-Carlo error."""
    from scipy import optimize, stats

    critical = _critical(np.array(participants), scenarios)
    n = np.array([each.n for each in power])
    # half a study more of each kind keeps 0 and 1 finite
    share = (np.array([each.count for each in power]) + 0.5) / (n + 1)
    score = stats.norm.ppf(share)
    shift = np.maximum(score + critical, _FAINTEST)
    error = 2 * shift**-3 * np.sqrt(share * (1 - share) / n) / stats.norm.pdf(score)
    terms = np.column_stack([np.ones(len(n)), 1 / np.array(participants)])
    # in units of 1 / participants[0], for the sake of the scale
    scale = np.array([1.0, participants[0]])
    found, _ = optimize.nnls(terms * scale / error[:, None], shift**-2 / error)
    floor, slope = (found * scale).tolist()
    return PowerCurve(floor, slope, scenarios)
