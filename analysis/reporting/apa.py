"""Sentences for a manuscript, in the style of the APA."""

from __future__ import annotations

from ..arms import Arms
from ..conclusions import Conclusion
from ..data_notices import WITH_THE_NUMBERS
from ..evidence import Evidence
from ..plan import Plan
from ..results import Results
from ..wording import capital, chi_square_apa, format_p, mann_whitney_apa
from .answers import WORDS, means
from .effects import bracketed, statement
from .excluded import excluded


def apa_sentences(results: Results) -> tuple[str, ...]:
    """Return a sentence a result: primary tests, models, stops, then the paper's tests.

    Before them stands what casts doubt on all numbers, such as simulated trials.
    """
    evidence, plan = results.evidence, results.data.plan
    paper = evidence.paper
    return (
        *(notice.text for notice in results.notices if notice.code in WITH_THE_NUMBERS),
        *(_primary(each, evidence, plan) for each in evidence.conclusions),
        *(
            f"Mixed model of {WORDS[each.measure].name}, participants and scenarios crossed: "
            f"{bracketed(each.model)}, {statement(each.model, plan.alpha)}."
            for each in evidence.conclusions
            if each.model is not None
        ),
        _stops(evidence, plan),
        "With trials taken as independent, as in the original study: correct guesses, "
        f"{chi_square_apa(paper.correct.test)}.",
        *(
            f"With trials taken as independent: {name}, {mann_whitney_apa(ranked.test)}."
            for name, ranked in (
                ("time of prediction", paper.prediction_time),
                ("confidence", paper.confidence),
            )
        ),
    )


def _primary(conclusion: Conclusion, evidence: Evidence, plan: Plan) -> str:
    words = WORDS[conclusion.measure].name
    tested = (
        "not to be tested with these data"
        if conclusion.direction == "undefined"
        else statement(conclusion.primary, plan.alpha)
    )
    corrected = (
        ""
        if conclusion.p_holm is None
        else f", Holm-corrected {format_p(conclusion.p_holm, alpha=plan.alpha)}"
    )
    compared = evidence.comparisons[conclusion.measure]
    said = (
        f"{capital(words)}: {means(compared, plan.arms)}, "
        f"{bracketed(conclusion.primary)}, {tested}{corrected} "
        f"({_arms(plan.arms)}; trials clustered by participant and scenario)."
    )
    return " ".join((said, *excluded(conclusion, compared, plan.arms)))


def _stops(evidence: Evidence, plan: Plan) -> str:
    """Tell the test that speaks of other scenarios too, or else the one of other participants."""
    two_way = evidence.two_way_cox.p is not None
    test = evidence.two_way_cox if two_way else evidence.cox
    return (
        f"Rate of correct stops: {bracketed(test)}, {statement(test, plan.alpha)} "
        f"({_arms(plan.arms)}; Cox regression, wrong stops censored, clustered by participant"
        f"{' and scenario' if two_way else ''})."
    )


def _arms(arms: Arms) -> str:
    return f"{arms.treatment.label} against {arms.reference.label}"
