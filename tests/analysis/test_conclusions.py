"""What is concluded: from the primary test alone, corrected, whatever stands beside it."""

from dataclasses import replace

import pytest

from analysis import default_plan
from analysis.conclusions import conclude
from analysis.methods import Comparison
from analysis.reporting.answers import answers
from analysis.reporting.document import Finding, Paragraph
from analysis.statistics.estimates import mean
from analysis.statistics.result import TestResult

PLAN = default_plan()


def result(p, *, estimate=0.1, null=0.0, unit="share"):
    return TestResult(
        estimate=estimate,
        low=None,
        high=None,
        null=null,
        unit=unit,
        symbol="t",
        statistic=2.0,
        df=36,
        p=p,
        n=1500,
        n_missing=0,
        method="a method",
        source="a source",
    )


def compared(measure, primary, **others):
    arms = mean([1.0, 0.0], "share"), mean([1.0, 0.0], "share")
    return Comparison(measure, "share", arms, "primary", {"primary": primary, **others}, {})


def concluded(p=(0.01, 0.01, 0.01), plan=PLAN, correct=0.1, **beside):
    auc = {"estimate": 0.4, "null": 0.5, "unit": "probability"}
    comparisons = {
        "correct": compared("correct", result(p[0], estimate=correct), **beside),
        "prediction_time_s": compared("prediction_time_s", result(p[1], **auc)),
        "confidence": compared("confidence", result(p[2], **auc)),
    }
    return conclude(plan, comparisons), comparisons


def test_less_time_supports_its_hypothesis_and_less_confidence_does_not():
    (correct, time, confidence), _ = concluded()
    assert (correct.direction, correct.supported) == ("more", True)
    assert (time.direction, time.supported) == ("less", True)
    assert (confidence.direction, confidence.supported) == ("less", False)


def test_the_corrected_p_decides_within_the_family():
    (correct, time, confidence), _ = concluded(p=(0.03, 0.03, 0.03))
    assert correct.p_holm == pytest.approx(0.09)
    assert {each.direction for each in (correct, time, confidence)} == {"none"}


def test_a_measure_outside_of_the_family_is_not_corrected():
    plan = replace(PLAN, holm_family=("correct",))
    (correct, time, _), _ = concluded(p=(0.03, 0.03, 0.03), plan=plan)
    assert correct.p_holm == pytest.approx(0.03)
    assert time.p_holm is None
    assert time.direction == "less"


def test_the_plans_alpha_decides():
    (correct, *_), _ = concluded(p=(0.01, 0.5, 0.5), plan=replace(PLAN, alpha=0.01))
    assert correct.direction == "none"


def test_a_test_that_is_not_defined_concludes_nothing_and_does_not_count_for_the_others():
    (correct, time, _), _ = concluded(p=(None, 0.02, 0.04))
    assert (correct.direction, correct.supported, correct.p_holm) == ("undefined", False, None)
    assert time.p_holm == pytest.approx(0.04)


def test_equal_values_are_not_tested_though_their_p_is_1_which_is_not_printed():
    constant = replace(result(1.0, estimate=0.0), warnings=("constant_outcome",), statistic=None)
    comparisons = {**concluded(p=(1.0, 0.02, 0.04))[1], "correct": compared("correct", constant)}
    correct, time, _ = conclusions = conclude(PLAN, comparisons)
    assert (correct.primary.p, correct.p_holm, correct.direction) == (1.0, None, "undefined")
    assert time.p_holm == pytest.approx(0.04)
    answer, *_ = said(conclusions, comparisons)
    assert answer.verdict == "H1, correct guesses: not to be tested with these data."
    assert answer.text.endswith("points. All values are equal, so the test is not defined.")


@pytest.mark.parametrize(
    ("p_model", "effect", "shown", "agree"),
    [
        (0.02, 0.8, "more", True),
        (0.049, 0.8, "more", True),
        (0.2, 0.8, "none", False),
        (0.02, -0.8, "less", False),
        (None, 0.8, "undefined", None),
    ],
)
def test_the_model_beside_agrees_if_it_shows_the_same(p_model, effect, shown, agree):
    model = result(p_model, estimate=effect, unit="log odds")
    (correct, *_), _ = concluded(crossed_logistic=model)
    assert (correct.direction, correct.model_direction) == ("more", shown)
    assert correct.models_agree is agree


def test_the_model_is_corrected_in_the_place_of_the_primary_test():
    """Holm by hand, of three: 2 x .038 by the test, 2 x .034 by the model; 3 x .0001 for time."""
    model = result(0.034, unit="log odds")
    (correct, time, _), _ = concluded(p=(0.038, 0.0001, 0.091), crossed_logistic=model)
    assert (correct.p_holm, correct.model_p_holm) == pytest.approx((0.076, 0.068))
    assert (correct.direction, correct.model_direction, correct.models_agree) == (
        "none",
        "none",
        True,
    )
    assert time.p_holm == pytest.approx(0.0003)


def test_a_model_outside_of_the_family_is_not_corrected():
    plan = replace(PLAN, holm_family=("prediction_time_s", "confidence"))
    model = result(0.034, unit="log odds")
    (correct, *_), _ = concluded(p=(0.038, 0.04, 0.04), plan=plan, crossed_logistic=model)
    assert (correct.model_p_holm, correct.model_direction) == (None, "more")
    assert correct.models_agree


def test_a_model_beside_a_test_that_is_not_defined_neither_agrees_nor_is_told():
    model = result(0.01, unit="log odds")
    conclusions, comparisons = concluded(p=(None, 0.01, 0.01), crossed_logistic=model)
    assert conclusions[0].models_agree is None
    assert "mixed model" not in said(conclusions, comparisons)[0].text


def said(conclusions, comparisons):
    return [
        part
        for part in answers(conclusions, comparisons, PLAN.arms, PLAN.alpha)
        if isinstance(part, Finding)
    ]


def test_a_model_that_disagrees_is_said_to_and_not_followed():
    correct, *_ = said(*concluded(crossed_logistic=result(0.2, unit="log odds")))
    assert correct.verdict == "H1, correct guesses: more with PoLMDP."
    assert "The mixed model disagrees (no difference shown at alpha = .05): odds" in correct.text
    assert "t(36) = 2.00, p = .200, Holm-corrected p = .200. The two-way" in correct.text
    assert "the conclusion is drawn from it" in correct.text


def test_a_model_that_shows_the_opposite_disagrees():
    model = result(0.001, estimate=-0.8, unit="log odds")
    correct, *_ = said(*concluded(crossed_logistic=model))
    assert "The mixed model disagrees (fewer with PoLMDP at alpha = .05)" in correct.text


def test_where_the_test_shows_no_difference_the_model_is_said_to_show_none_either():
    """Raw p's below alpha on both sides, of which nothing is left by Holm."""
    model = result(0.034, unit="log odds")
    correct, *_ = said(*concluded(p=(0.038, 0.0001, 0.091), crossed_logistic=model))
    assert correct.verdict == "H1, correct guesses: no difference shown at alpha = .05."
    assert "The mixed model shows no difference either: odds ratio" in correct.text
    assert "p = .034, Holm-corrected p = .068." in correct.text
    assert "agrees" not in correct.text


def test_a_difference_against_the_hypothesis_is_said_to_be_so():
    correct, _, confidence = said(*concluded(correct=-0.1))
    assert correct.verdict == "H1, correct guesses: fewer with PoLMDP, against the hypothesis."
    assert confidence.verdict == "H2, confidence: lower with PoLMDP, against the hypothesis."


@pytest.mark.parametrize(
    ("auc_of_confidence", "p", "verdict"),
    [
        (0.6, (0.01, 0.01, 0.01), "shown"),
        (0.6, (0.01, 0.01, 0.2), "in part"),
        (0.4, (0.01, 0.01, 0.01), "in part"),
        (0.6, (0.01, None, 0.01), "in part"),
        (0.4, (0.01, None, 0.01), "not shown"),
        (0.6, (0.01, 0.2, 0.2), "not shown"),
        (0.6, (0.01, None, None), "not to be tested with these data"),
    ],
)
def test_a_hypothesis_of_two_measures_has_one_answer(auc_of_confidence, p, verdict):
    comparisons = concluded(p=p)[1]
    confidence = result(p[2], estimate=auc_of_confidence, null=0.5, unit="probability")
    comparisons["confidence"] = compared("confidence", confidence)
    told = answers(conclude(PLAN, comparisons), comparisons, PLAN.arms, PLAN.alpha)
    assert [part.text for part in told if isinstance(part, Paragraph)] == [
        f"H2 (shorter time of prediction and higher confidence): {verdict}."
    ]


def test_an_auc_below_a_half_is_told_by_the_larger_share_of_pairs():
    _, time, _ = said(*concluded())
    assert "60.0 % have the shorter time of prediction with PoLMDP" in time.text
    assert "AUC = .400" in time.text
