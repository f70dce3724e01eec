"""What resemblance of a participant's trials does to a test that takes them as independent."""

from __future__ import annotations

from dataclasses import dataclass

from .estimates import LEVEL


@dataclass(frozen=True)
class TippingPoint:
    """How much clustering a test on trials bears before it is no longer significant.

    `design_effect_max` is the largest design effect, `icc_max` the intraclass correlation that
    makes it, None with one trial per participant; below 0 if the test is not significant even
    with independent trials. `robust_to_any_icc`: no correlation up to 1 can tip the verdict.
    """

    design_effect_max: float
    icc_max: float | None
    robust_to_any_icc: bool


def design_effect(icc: float, trials_per_participant: float) -> float:
    """Factor by which clustering raises the variance of a mean or a difference: 1 + (m - 1) icc.

    m is `trials_per_participant`, as IntraclassCorrelation has it where the numbers differ.
    Source: Kish (1965), Survey Sampling.
    """
    return 1 + (trials_per_participant - 1) * icc


def tipping_icc(statistic: float, trials_per_participant: float) -> TippingPoint:
    """Find where a chi-square on 1 degree of freedom (or a z squared) stops being significant.

    `statistic` takes trials as independent; clustering divides it by the design effect, and it
    must exceed the 95 % quantile. Source: Kish (1965); Rao and Scott (1981).
    """
    from scipy.special import chdtri

    largest = statistic / float(chdtri(1, 1 - LEVEL))
    further = trials_per_participant - 1
    return TippingPoint(
        design_effect_max=largest,
        icc_max=(largest - 1) / further if further else None,
        robust_to_any_icc=largest > max(1.0, design_effect(1.0, trials_per_participant)),
    )
