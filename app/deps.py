"""What routes share: the services of an app, the session's cookie, replies."""

import json
from dataclasses import dataclass
from typing import Any

from fastapi import Request
from fastapi.responses import HTMLResponse, RedirectResponse
from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from app.database import Database
from app.errors import TooMany, WrongStep
from app.limits import Moderation
from app.pages import Pages
from app.repository import Record
from app.root_path import root_path
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
    consents: Moderation


def services(request: Request) -> Services:
    """The services of the app that handles a request."""
    found: Services = request.app.state.services
    return found


def token_of(request: Request) -> str | None:
    """The session's token in the browser's cookie."""
    return request.cookies.get(COOKIE)


async def participant_at(request: Request, *steps: Step) -> Record:
    """The participant, who must be at one of the steps; AtAnotherStep leads to theirs."""
    token = token_of(request)
    participant = await services(request).database.read(
        lambda connection: participant_of(connection, token)
    )
    if participant.step not in steps:
        raise AtAnotherStep(Step(participant.step))
    return participant


async def in_moderation(request: Request) -> None:
    """Let somebody begin; TooMany when many have just begun from their network."""
    wait_s = services(request).consents.wait_s(request.client.host if request.client else None)
    if wait_s:
        raise TooMany(wait_s)


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


class _Elsewhere(RedirectResponse):
    """A redirect to a page of ours, under whatever path the study has on its host."""

    def __init__(self, path: str, token: str | None, secure: bool) -> None:
        super().__init__(path, 303, headers={"Cache-Control": "no-store"})
        self.path, self.token, self.secure = path, token, secure

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        root = root_path(scope)
        self.headers["location"] = root + self.path
        if self.token:
            self.set_cookie(
                COOKIE,
                self.token,
                max_age=COOKIE_SECONDS,
                path=root or "/",
                httponly=True,
                samesite="lax",
                secure=self.secure,
            )
        await super().__call__(scope, receive, send)


def see(path: str, token: str | None = None, secure: bool = False) -> Response:
    """Send the browser to a page with GET; with a token, begin a session there."""
    return _Elsewhere(path, token, secure)


def forget_browser(request: Request, response: Response) -> None:
    """Let a reply end the session, and clear what the browser has stored."""
    root = root_path(request.scope)
    if root:
        # The host is not ours alone: what other sites under it have stored stays.
        response.delete_cookie(COOKIE, path=root)
    else:
        response.headers["Clear-Site-Data"] = '"cookies", "storage"'


def as_json(content: Any, status: int = 200) -> Response:
    """A JSON reply that no cache keeps."""
    body = json.dumps(content, separators=(",", ":"), allow_nan=False)
    return Response(
        body, status, headers={"Cache-Control": "no-store"}, media_type="application/json"
    )
