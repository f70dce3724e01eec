"""The participant's pages: parse, call, reply."""

import secrets
from contextlib import suppress

from fastapi import APIRouter, Request
from fastapi.responses import Response

from app import answering, arrival, enrolment
from app.answering import TrialScore
from app.arrival import Link
from app.deps import (
    PATHS,
    page,
    participant_at,
    recruiter,
    see,
    services,
    token_of,
)
from app.errors import (
    CLOSED_TO_ARRIVALS,
    CLOSED_TO_WITHDRAWAL,
    InvalidInput,
    NoSession,
    StudyClosed,
)
from app.questions import ABOUT_YOU, CONTROL, answers
from app.steps import ENDINGS, Step, may_withdraw
from app.study import Study

router = APIRouter(include_in_schema=False)

BEST_SCORE_OF_TRIAL = 10


@router.get("/")
async def arrive(request: Request) -> Response:
    """The invitation link: whoever is known goes on where they were."""
    link = Link.read(request.query_params)
    at, token = services(request), token_of(request)
    known = await at.database.read(lambda c: arrival.find(c, link, token))
    if known is None and not at.study.settings.study_open:
        raise StudyClosed(CLOSED_TO_ARRIVALS)
    if known is None:
        fields = {**link.fields(), "arrival": secrets.token_urlsafe(16)}
        return page(request, "consent.html", {"consent": at.study.consent, "link": fields})
    path = PATHS[Step(known.participant.step)]
    if not known.moves:
        return see(path)
    agent = _user_agent(request)
    token = await at.database.write(lambda c: arrival.come_back(c, at.study, known, agent))
    return see(path, token, secure=request.url.scheme == "https")


@router.post("/consent")
async def consent(request: Request) -> Response:
    """Yes makes the participant; no is only counted."""
    form = await _form(request)
    at, old_token, agent = services(request), token_of(request), _user_agent(request)
    link = Link.read(form)
    if form.get("decision") != "yes":
        await at.database.write(lambda c: arrival.decline(c, link))
        return see("/no-consent")
    nonce = form.get("arrival", "")
    if not 16 <= len(nonce) <= 64:
        raise InvalidInput("arrival: expected the hidden field of the consent page.")
    token = await at.database.write(
        lambda c: arrival.consent(c, at.study, nonce, link, old_token, agent)
    )
    return see("/about-you", token, secure=request.url.scheme == "https")


@router.get("/no-consent")
async def no_consent(request: Request) -> Response:
    """For whoever did not agree."""
    return page(request, "no_consent.html", {"recruiter": recruiter(request, "no_consent")})


@router.get("/about-you")
async def about_you(request: Request) -> Response:
    """The questions about the participant."""
    participant = await participant_at(request, Step.ABOUT_YOU)
    context = {"questions": ABOUT_YOU, "answers": {}, "errors": {}}
    return page(request, "about_you.html", context, participant)


@router.post("/about-you")
async def describe(request: Request) -> Response:
    """Answers to them; what is wrong is shown again beside what was right."""
    participant = await participant_at(request, Step.ABOUT_YOU)
    form = await _form(request)
    given, errors = answers(ABOUT_YOU, form)
    if errors:
        context = {"questions": ABOUT_YOU, "answers": form, "errors": errors}
        return page(request, "about_you.html", context, participant, status=422)
    at, token = services(request), token_of(request)
    await at.database.write(lambda c: enrolment.describe(c, at.study, token, given))
    return see("/instructions")


@router.get("/instructions")
async def instructions(request: Request) -> Response:
    """How the game goes."""
    participant = await participant_at(request, Step.INSTRUCTIONS)
    return page(request, "instructions.html", participant=participant)


@router.post("/instructions")
async def finish_instructions(request: Request) -> Response:
    """Read and understood."""
    at, token = services(request), token_of(request)
    await at.database.write(lambda c: enrolment.finish_instructions(c, at.study, token))
    return see("/practice")


@router.get("/practice")
async def practice(request: Request) -> Response:
    """One animation to try, then the control question."""
    participant = await participant_at(request, Step.PRACTICE)
    context = {
        "question": CONTROL,
        "attempt": participant.control_tries + 1,
        "wrong": participant.control_tries > 0,
    }
    return page(request, "practice.html", context, participant)


@router.post("/practice")
async def answer_control(request: Request) -> Response:
    """The answer to the control question."""
    form = await _form(request)
    at, token = services(request), token_of(request)
    try:
        attempt, answer = int(form.get("attempt", "")), CONTROL.answer(form)
    except ValueError:
        return see("/practice")
    step = await at.database.write(
        lambda c: enrolment.answer_control(c, at.study, token, attempt, answer)
    )
    return see(PATHS[step])


@router.get("/trial")
async def trial(request: Request) -> Response:
    """The page that runs all trials; whoever lost their place is dealt a new one."""
    participant = await participant_at(request, Step.TRIALS)
    at, token = services(request), token_of(request)
    placed = await at.database.read(lambda c: enrolment.has_place(c, participant))
    if not placed:
        await at.database.write(lambda c: enrolment.deal_again(c, at.study, token))
    return page(request, "trial.html", {"dealt_again": not placed}, participant)


@router.get("/end")
async def end(request: Request) -> Response:
    """The page of how it ended."""
    participant = await participant_at(request, *ENDINGS)
    context: dict[str, object] = {"recruiter": recruiter(request, participant.step)}
    if participant.step == Step.COMPLETED:
        study = services(request).study
        scores = await services(request).database.read(
            lambda c: answering.scores(c, study, participant)
        )
        context |= {
            "score": sum(one.score for one in scores),
            "best": BEST_SCORE_OF_TRIAL * study.trials,
            "trials": [_shown(study, one) for one in scores],
        }
    return page(request, f"{participant.step}.html", context, participant)


@router.post("/failed")
async def fail(request: Request) -> Response:
    """The study does not work for this participant."""
    at, token = services(request), token_of(request)
    await at.database.write(lambda c: enrolment.fail(c, at.study, token))
    return see("/end")


@router.get("/withdraw")
async def confirm_withdrawal(request: Request) -> Response:
    """What withdrawing means, before it is done."""
    participant = await participant_at(request, *Step)
    if not may_withdraw(Step(participant.step), services(request).study.settings.study_open):
        raise StudyClosed(CLOSED_TO_WITHDRAWAL)
    return page(request, "withdraw.html", participant=participant)


@router.post("/withdraw")
async def withdraw(request: Request) -> Response:
    """Delete everything about the participant and forget the browser."""
    at, token = services(request), token_of(request)
    # Without a session it has been done already: the button was pressed twice.
    with suppress(NoSession):
        await at.database.write(lambda c: enrolment.withdraw(c, at.study, token))
        await at.database.forget_deleted()
    response = see("/withdrawn")
    response.headers["Clear-Site-Data"] = '"cookies", "storage"'
    return response


@router.get("/withdrawn")
async def withdrawn(request: Request) -> Response:
    """The last word to whoever withdrew."""
    return page(request, "withdrawn.html", {"recruiter": recruiter(request, "withdrawn")})


def _user_agent(request: Request) -> str:
    return request.headers.get("user-agent", "")[:400]


async def _form(request: Request) -> dict[str, str]:
    async with request.form(max_files=0, max_fields=50) as form:
        return {name: value for name, value in form.items() if isinstance(value, str)}


def _shown(study: Study, one: TrialScore) -> dict[str, object]:
    """A finished trial with its small picture: what was seen of the path, and the rest."""
    picture = study.picture(one.stimulus)
    path = picture.pop("path")
    return {
        "index": one.index,
        "correct": one.correct,
        "guess": one.guess,
        "goal": one.stimulus.goal,
        "stop_time_s": one.stop_time_s,
        "length_s": one.length_s,
        "score": one.score,
        "picture": {
            **picture,
            "seen": path[: one.steps_seen + 1],
            "rest": path[one.steps_seen + 1 :],
        },
    }
