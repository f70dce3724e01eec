"""What routes share: the services of an app, the session's cookie, replies."""

import json
from dataclasses import dataclass
from typing import Any

from fastapi import Request
from fastapi.responses import HTMLResponse, RedirectResponse
from starlette.responses import Response

from app.database import Database
from app.errors import WrongStep
from app.pages import Pages
from app.repository import Record
from app.sessions import participant_of
from app.settings import Ending
from app.steps import ENDINGS, Step, may_withdraw
from app.study import PREVIEW, Study

COOKIE = "goalguess_session"
COOKIE_SECONDS = 90 * 24 * 3600

PATHS = {
    Step.ABOUT_YOU: "/about-you",
    Step.INSTRUCTIONS: "/instructions",
    Step.PRACTICE: "/practice",
    Step.TRIALS: "/trial",
    **dict.fromkeys(ENDINGS, "/end"),
}
"""Where each step's page is."""

OWN_PAGE = PATHS[Step.COMPLETED]
"""A page that sends everybody who is not there to their own."""


class AtAnotherStep(WrongStep):
    """A page was asked for that is not the participant's; they are sent to theirs."""

    def __init__(self, step: Step) -> None:
        super().__init__(f"The page of step {step} comes next.")
        self.path = PATHS[step]


@dataclass(frozen=True)
class Services:
    """What an app is made of, `app.state.services`."""

    study: Study
    database: Database
    pages: Pages


def services(request: Request) -> Services:
    """The services of the app that handles a request."""
    found: Services = request.app.state.services
    return found


def token_of(request: Request) -> str | None:
    """The session's token in the browser's cookie."""
    return request.cookies.get(COOKIE)


async def participant_at(request: Request, *steps: Step, whose: str | None = None) -> Record:
    """The participant, who must be at one of the steps; AtAnotherStep leads to theirs.

    `whose`: as the page says it, see `sessions.participant_of`.
    """
    token = token_of(request)
    participant = await services(request).database.read(
        lambda connection: participant_of(connection, token, whose)
    )
    if participant.step not in steps:
        raise AtAnotherStep(Step(participant.step))
    return participant


def page(
    request: Request,
    template: str,
    context: dict[str, Any] | None = None,
    participant: Record | None = None,
    status: int = 200,
) -> HTMLResponse:
    """A page, for a participant with the way to withdraw where there is one."""
    at = services(request)
    return at.pages.render(
        template,
        context or {},
        participant=participant.pseudonym if participant else None,
        preview=participant is not None and participant.stream == PREVIEW,
        can_withdraw=participant is not None
        and may_withdraw(Step(participant.step), at.study.settings.study_open),
        status=status,
    )


def recruiter(request: Request, ending: Ending) -> dict[str, str | None]:
    """The way back to the recruiter from an ending, where it has a code."""
    settings = services(request).study.settings
    code = settings.codes.get(ending)
    return {"code": code, "url": settings.return_url.replace("{code}", code) if code else None}


def see(path: str, token: str | None = None, secure: bool = False) -> RedirectResponse:
    """Send the browser to a page with GET; with a token, begin a session there."""
    response = RedirectResponse(path, 303, headers={"Cache-Control": "no-store"})
    if token:
        response.set_cookie(
            COOKIE,
            token,
            max_age=COOKIE_SECONDS,
            httponly=True,
            samesite="lax",
            secure=secure,
        )
    return response


def as_json(content: Any, status: int = 200) -> Response:
    """A JSON reply that no cache keeps."""
    body = json.dumps(content, separators=(",", ":"), allow_nan=False)
    return Response(
        body, status, headers={"Cache-Control": "no-store"}, media_type="application/json"
    )
