"""What the warnings of results mean to a reader: each completes a sentence that names the test."""

from .statistics import codes

WARNINGS = {
    codes.COARSE_VALUES: "values are tied so often that an interval would be a single shift, or "
    "hold 0 though the Mann-Whitney test rejects it; it is left out, and the AUC tells more",
    codes.CONSTANT_OUTCOME: "all values are equal, so the test is not defined",
    codes.DEGENERATE_MARGIN: "all guesses were alike, so the arms cannot be told apart",
    codes.FEW_CLUSTERS: "fewer than 10 participants in an arm, or scenarios; interval and p are "
    "rough",
    codes.NOT_CONVERGED: "the fit did not converge, so nothing is estimated",
    codes.NO_OVERLAP: "the arms do not overlap at all, so the variance of the AUC is 0; the mean "
    "difference and the permutation of participants tell more",
    codes.NO_SCENARIO_KNOWN: "no scenario is known, so only participants are taken as drawn from "
    "many",
    codes.NO_SCENARIO_SHARED: "every scenario was seen in one arm only, so how scenarios differ "
    "cannot be told from the condition",
    codes.NO_VARIATION: "participants do not differ, so there is no standard error",
    codes.ONE_PARTICIPANT: "an arm has a single participant, which does not tell how participants "
    "differ",
    codes.ONE_SCENARIO: "all trials are of one scenario, which does not tell how scenarios differ",
    codes.SCENARIOS_NOT_SHARED: "some scenarios were seen in one arm only, where they cannot be "
    "told from the condition",
    codes.SEPARATION: "an arm shows one kind of answer only, so the ratio is 0 or infinite",
    codes.SINGLE_TRIALS: "participants have one trial each, so nothing is known of their likeness",
    codes.TOO_FEW_VALUES: "fewer than three values, so the test is not defined",
    codes.TOO_MANY_CLUSTERS: "more than 500 scenarios, for which the fit would take too long",
    codes.ZERO_CELL: "a cell of the 2x2 table is empty",
    codes.ZERO_VARIANCE: "participants or scenarios differ no more than chance lets them, so a "
    "variance is estimated as 0",
}
"""By code."""
