"""No interval contradicts its own p: in numbers and as printed, by every method that has both."""

import re
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from scipy import stats

from analysis.figures.forest import figure_forest
from analysis.methods import methods_of
from analysis.reporting.effects import bracketed, effect_of, estimate_cell, interval, statement
from analysis.reporting.method_tables import in_shares
from analysis.statistics.calibration import discrimination
from analysis.statistics.chance import against_chance
from analysis.statistics.cox import clustered_cox, two_way_cox
from analysis.statistics.dropout import differential_dropout
from analysis.statistics.intraclass import (
    intraclass_correlation,
    intraclass_correlation_of_ranks,
)
from analysis.statistics.mixed_model import CrossedLogistic
from analysis.statistics.outcome import Outcome
from analysis.statistics.result import TestResult
from analysis.statistics.survival import stops
from tests.analysis.figures.studies import LABELS


def study(seed, effect):
    """Right guesses, confidence and times of a small study; participants and scenarios differ."""
    rng = np.random.default_rng(seed)
    participants, scenarios, trials = rng.integers((6, 4, 2), (24, 12, 8)).tolist()
    participant = np.repeat(np.arange(participants), trials)
    treated = participant % 2 == 0
    scenario = rng.integers(0, scenarios, len(participant))
    latent = (
        effect * treated
        + 0.8 * rng.normal(size=participants)[participant]
        + 0.5 * rng.normal(size=scenarios)[scenario]
        + rng.logistic(size=len(participant))
    )
    clusters = (treated, participant, scenario)
    return (
        Outcome("correct", "share", (latent > -0.5).astype(float), *clusters),
        Outcome("confidence", "scale points", np.clip(np.rint(4 + latent), 1, 7), *clusters),
        Outcome("prediction_time_s", "s", 20 / (1 + np.exp(latent / 3)), *clusters),
    )


def results(seed, effect) -> Iterator[tuple[str, TestResult]]:
    correct, confidence, time = study(seed, effect)
    for data in (correct, confidence, time):
        for key, method in methods_of(data.name, "two_way_auc", 1).items():
            found = method.run(data)
            yield f"{key} of {data.name}", found
            if isinstance(found, CrossedLogistic) and found.risk_difference is not None:
                yield f"{key} in shares", in_shares(found)
    clusters = (correct.treated, correct.participant, correct.scenario)
    ends = stops(time.y, np.full(len(time.y), 12.0), correct.y, *clusters)
    yield "Cox", clustered_cox(ends)
    yield "two-way Cox", two_way_cox(ends)
    yield "likeness", intraclass_correlation(correct)
    yield "likeness of ranks", intraclass_correlation_of_ranks(confidence)
    yield from zip(("chance, treatment", "reference"), against_chance(correct, 1 / 6), strict=True)
    for arm, auc in enumerate(discrimination(correct, confidence.y)):
        yield f"discrimination of arm {arm}", auc
    done = np.bincount(correct.participant, correct.y) > 1
    yield "dropout", differential_dropout(np.arange(len(done)) % 2 == 0, done)


def excludes(low, high, null):
    return low > null or high < null


def numbers(text):
    return [float(number) for number in re.findall(r"-?\d*\.?\d+(?:e[+-]\d+)?", text)]


def printed_null(result):
    """The null value as its unit is written; the interval's usual decimals are enough for it."""
    return float(effect_of(result).write(result.null, 12))


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.integers(0, 2**32 - 1), st.floats(-1.5, 2))
@example(1, 0.0)
def test_an_interval_excludes_the_null_value_exactly_if_its_p_is_below_05(seed, effect):
    for name, found in results(seed, effect):
        if found.p is None or found.low is None or found.high is None:
            continue
        assert excludes(found.low, found.high, found.null) == (found.p < 0.05), name
        low, high = numbers(interval(found))
        if found.null != 1 / 6:  # whose table prints it with as many decimals
            assert excludes(low, high, printed_null(found)) == (found.p < 0.05), name
        printed = statement(found, 0.05)
        if "p = " in printed:
            assert (float(printed.partition("p = ")[2]) < 0.05) == (found.p < 0.05), name


def near(distance, unit="share", null=0.0, se=0.08):
    """A result whose bound is so far above the null value, in standard errors, or below it."""
    half = stats.t.ppf(0.975, 30)
    t = half + distance
    return TestResult(
        estimate=null + t * se,
        low=null + distance * se,
        high=null + (t + half) * se,
        null=null,
        unit=unit,
        symbol="t",
        statistic=t,
        df=30,
        p=2 * stats.t.sf(t, 30),
        n=1500,
        n_missing=0,
        method="a method",
        source="a source",
    )


UNITS = st.sampled_from(
    [("share", 0.0), ("s", 0.0), ("scale points", 0.0), ("probability", 0.5), ("log odds", 0.0)]
)


@given(st.floats(-0.05, 0.05).filter(lambda far: abs(far) > 1e-8), UNITS, st.booleans())
def test_a_bound_next_to_the_null_value_is_printed_on_its_side(distance, scale, below):
    unit, null = scale
    found = near(distance, unit, null)
    if below:
        low, high = (2 * null - bound for bound in (found.high, found.low))
        found = TestResult(**{**vars(found), "low": low, "high": high})
    texts = [interval(found), bracketed(found).partition("[")[2]]
    drawn = figure_forest({"it": found}, "it", "effect", LABELS, 0.05).alt
    texts.append(drawn.partition("[")[2].partition("]")[0])
    for place, text in enumerate(texts):
        low, high = numbers(text)
        expected = 1.0 if unit == "log odds" and place < 2 else null
        assert excludes(low, high, expected) == (distance > 0), text


@pytest.mark.parametrize(
    ("found", "printed"),
    [
        (near(0.005), "0.04 to 32.72"),
        (near(-0.005), "0.0 to 32.6"),
        (near(0.005, "log odds"), "1.0004 to 1.3870"),
        (near(0.005, "probability", 0.5), ".5004 to .8272"),
        (near(0.5), "4.0 to 36.7"),
    ],
)
def test_an_interval_gets_decimals_only_where_rounding_would_hide_what_it_shows(found, printed):
    assert interval(found) == printed


def test_the_estimate_has_the_decimals_of_its_interval():
    found = near(0.005, "log odds")
    assert bracketed(found) == "odds ratio = 1.1780, 95 % CI [1.0004, 1.3870]"
    assert estimate_cell(found) == "odds ratio 1.1780"


def test_a_bound_that_is_the_null_value_but_for_rounding_ends_in_some_decimals():
    assert interval(near(1e-17, "log odds")).startswith("1.00000000000000 to ")
