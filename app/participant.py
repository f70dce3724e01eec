"""The participant's pages: parse, call, reply."""

import secrets
from collections.abc import Callable
from contextlib import suppress
from typing import Any
from urllib.parse import urlencode

from fastapi import APIRouter, Request
from fastapi.responses import Response
from fastapi.routing import APIRoute

from app import answering, arrival, enrolment
from app.answering import TrialScore
from app.arrival import Link, read_arrival, stream_of
from app.deps import (
    PATHS,
    forget_browser,
    page,
    participant_at,
    recruiter,
    require_moderation,
    see,
    services,
    token_of,
)
from app.errors import (
    CLOSED_TO_ARRIVALS,
    InvalidInput,
    NoSession,
    StudyClosed,
)
from app.questions import ABOUT_YOU, CONTROL, answers
from app.recruiter_ids import warn_of
from app.steps import ENDINGS, Step
from app.study import PARTICIPANT, Study


class _Page(APIRoute):
    """A page that also says, without its content, how it would answer."""

    def __init__(self, path: str, endpoint: Callable[..., Any], **options: Any) -> None:
        super().__init__(path, endpoint, **options)
        if self.methods and "GET" in self.methods:
            self.methods.add("HEAD")


router = APIRouter(include_in_schema=False, route_class=_Page)

BEST_SCORE_OF_TRIAL = 10
WHOSE = "participant"
"""The hidden field by which each form says whose page it is on."""
OTHER_INVITATION = "other-invitation"


@router.get("/")
async def arrive(request: Request) -> Response:
    """The invitation link: whoever is known goes on where they were."""
    link = Link.read(request.query_params)
    at, token = services(request), token_of(request)
    known = await at.database.read(lambda c: arrival.find(c, link, token))
    if known is None and not at.study.settings.study_open:
        raise StudyClosed(CLOSED_TO_ARRIVALS)
    if known is None:
        if link.misnamed and link.recruiter_id is None:
            warn_of(link.misnamed)
        link.require_of_newcomer(at.study.settings.require_id)
        fields = {**link.fields(), "arrival": secrets.token_urlsafe(16)}
        return page(request, "consent.html", {"consent": at.study.consent, "link": fields})
    step = Step(known.participant.step)
    if known.elsewhere:
        context = {"link": link.fields(), "ended": step in ENDINGS}
        return page(request, "go_on_here.html", context)
    return see(_path(step, known.same_invitation))


@router.post("/go-on")
async def go_on(request: Request) -> Response:
    """The button by which whoever opened their link in another browser goes on there."""
    form = request.state.form = await _form(request)
    link, agent = Link.read(form), _user_agent(request)
    require_moderation(request)
    at, old_token = services(request), token_of(request)
    gone_on = await at.database.write(
        lambda c: arrival.go_on_here(c, at.study, link, old_token, agent)
    )
    if gone_on is None:
        return see(f"/?{urlencode(link.fields())}")
    known, token = gone_on
    path = _path(Step(known.participant.step), known.same_invitation)
    return see(path, token, secure=request.url.scheme == "https")


@router.post("/consent")
async def consent(request: Request) -> Response:
    """Yes makes the participant; no is only counted."""
    form = request.state.form = await _form(request)
    require_moderation(request)
    at, old_token, agent = services(request), token_of(request), _user_agent(request)
    link, nonce, decision = Link.read(form), read_arrival(form), form.get("decision")
    if decision not in ("yes", "no"):
        raise InvalidInput("decision: expected yes or no, by a button of the consent page.")
    if decision == "no":
        out = await at.database.write(lambda c: arrival.decline(c, nonce, link, old_token))
        return see(_of_stream("/no-consent", link.stream) if out else "/withdraw")
    token = await at.database.write(
        lambda c: arrival.consent(c, at.study, nonce, link, old_token, agent)
    )
    if token is None:
        return see(f"/?{urlencode(link.fields())}")
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
    form = await _form(request)
    participant = await participant_at(request, Step.ABOUT_YOU, whose=form.get(WHOSE))
    given, errors = answers(ABOUT_YOU, form)
    if errors:
        context = {"questions": ABOUT_YOU, "answers": form, "errors": errors}
        return page(request, "about_you.html", context, participant, status=422)
    at, token, whose = services(request), token_of(request), form.get(WHOSE)
    await at.database.write(lambda c: enrolment.describe(c, at.study, token, whose, given))
    return see("/instructions")


@router.get("/instructions")
async def instructions(request: Request) -> Response:
    """How the game goes."""
    participant = await participant_at(request, Step.INSTRUCTIONS)
    return page(request, "instructions.html", participant=participant)


@router.post("/instructions")
async def finish_instructions(request: Request) -> Response:
    """Read and understood."""
    at, token, whose = services(request), token_of(request), (await _form(request)).get(WHOSE)
    await at.database.write(lambda c: enrolment.finish_instructions(c, at.study, token, whose))
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
    at, token, whose = services(request), token_of(request), form.get(WHOSE)
    try:
        attempt, answer = int(form.get("attempt", "")), CONTROL.answer(form)
    except ValueError:
        return see("/practice")
    step = await at.database.write(
        lambda c: enrolment.answer_control(c, at.study, token, whose, attempt, answer)
    )
    return see(PATHS[step])


@router.get("/trial")
async def trial(request: Request) -> Response:
    """The page that runs all trials."""
    participant = await participant_at(request, Step.TRIALS)
    return page(request, "trial.html", participant=participant)


@router.get("/end")
async def end(request: Request) -> Response:
    """The page of how it ended; its code is for the invitation with which it was reached."""
    participant = await participant_at(request, *ENDINGS)
    own = OTHER_INVITATION not in request.query_params and await services(request).database.read(
        lambda c: arrival.has_own_code(c, participant)
    )
    context: dict[str, object] = {
        "recruiter": recruiter(request, participant.step, participant) if own else None
    }
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
    at, token, whose = services(request), token_of(request), (await _form(request)).get(WHOSE)
    await at.database.write(lambda c: enrolment.fail(c, at.study, token, whose))
    return see("/end")


@router.get("/withdraw")
async def confirm_withdrawal(request: Request) -> Response:
    """What withdrawing means, before it is done."""
    participant = await participant_at(request, *Step, whose=request.query_params.get(WHOSE))
    enrolment.require_way_out(services(request).study, participant)
    return page(request, "withdraw.html", participant=participant)


@router.post("/withdraw")
async def withdraw(request: Request) -> Response:
    """Delete everything about the participant and forget the browser."""
    form, at, token = await _form(request), services(request), token_of(request)
    stream = stream_of(form)
    # Without a session it has been done already: the button was pressed twice.
    with suppress(NoSession):
        stream = await at.database.write(
            lambda c: enrolment.withdraw(c, at.study, token, form.get(WHOSE))
        )
        await at.database.forget_deleted()
    response = see(_of_stream("/withdrawn", stream))
    forget_browser(request, response)
    return response


@router.get("/withdrawn")
async def withdrawn(request: Request) -> Response:
    """The last word to whoever withdrew."""
    return page(request, "withdrawn.html", {"recruiter": recruiter(request, "withdrawn")})


def _path(step: Step, same_invitation: bool = True) -> str:
    """Where a step's page is; its ending gives no code to another invitation."""
    hidden = step in ENDINGS and not same_invitation
    return f"{PATHS[step]}?{OTHER_INVITATION}" if hidden else PATHS[step]


def _user_agent(request: Request) -> str:
    return request.headers.get("user-agent", "")[:400]


def _of_stream(path: str, stream: str) -> str:
    """The address of a page that knows no session, by which it still knows a pilot."""
    return path if stream == PARTICIPANT else f"{path}?{stream}=1"


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
