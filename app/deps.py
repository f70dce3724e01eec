"""What routes share: the services of an app, the session's cookie, replies."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlencode

from fastapi import Request
from fastapi.responses import HTMLResponse, RedirectResponse
from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from app import repository
from app.arrival import stream_of
from app.database import Database
from app.errors import DatabaseUnavailable, NoSession, TooMany, WrongStep
from app.limits import Moderation
from app.pages import Pages
from app.recruiter_ids import PARAMETERS
from app.repository import Record
from app.root_path import own_path, root_path
from app.sessions import hashed, participant_of
from app.settings import Ending
from app.steps import ENDINGS, Step, may_withdraw
from app.study import PILOTS, Study

COOKIE = "goalguess_session"
"""Under a path its name has the path, too: browsers send a host's other cookies along."""
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
    return request.cookies.get(cookie_name(request.scope))


def cookie_name(scope: Scope) -> str:
    """The name of the session's cookie of this study on its host."""
    return COOKIE + root_path(scope).replace("/", "-")


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


def require_moderation(request: Request) -> None:
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
        pilot=pilot_of(request, participant),
        can_withdraw=participant is not None
        and participant.proven
        and may_withdraw(Step(participant.step), at.study.settings.study_open),
        status=status,
    )


def pilot_of(request: Request, participant: Record | None = None) -> str | None:
    """The stream of a pilot, as their row, the request's link or its session tells; else None."""
    if participant is not None:
        streams = [participant.stream]
    else:
        streams = [stream_of(_link_values(request)), getattr(request.state, "stream", None)]
    return next((stream for stream in streams if stream in PILOTS), None)


def recognise(request: Request) -> None:
    """Note the stream of the browser's session, if it has one, for pages that need none."""
    token = token_of(request)
    if token is None:
        return
    known = services(request).database.read_now(
        lambda connection: repository.participant_in_session(connection, hashed(token))
    )
    if known is not None:
        request.state.stream = known.stream


def recruiter(
    request: Request, ending: Ending, participant: Record | None = None
) -> dict[str, str | bool | None]:
    """The way back to the recruiter from an ending, where it has a code.

    Pilots are shown only that there is one: a code of theirs would be somebody's pay.
    """
    settings = services(request).study.settings
    code = settings.codes.get(ending) or None
    pilot = pilot_of(request, participant) is not None
    return {
        "code": None if pilot else code,
        "url": settings.return_url.replace("{code}", code) if code and not pilot else None,
        "stands_for_code": pilot and code is not None,
    }


def way_on(request: Request, error: Exception) -> str | None:
    """Where an error page can lead without making a second person of one; None: nowhere.

    That is the invitation, if the request has it, or the participant's own page. While nothing can
    be stored, loading the page again sends the form again; a button would lose it.
    """
    if isinstance(error, DatabaseUnavailable):
        return None
    values = _link_values(request)
    kept = {name: values[name] for name in (*PARAMETERS, *PILOTS) if values.get(name)}
    if kept:
        return f"/?{urlencode(kept)}"
    if own_path(request.scope) in ("", "/") or "arrival" in values:
        return "/"
    has_session = token_of(request) is not None and not isinstance(error, NoSession)
    return OWN_PAGE if has_session else None


def _link_values(request: Request) -> Mapping[str, str]:
    """What this request carries of an invitation link: in the consent form or in its query."""
    values: Mapping[str, str] = getattr(request.state, "form", request.query_params)
    return values


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
                cookie_name(scope),
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
        response.delete_cookie(cookie_name(request.scope), path=root)
    else:
        response.headers["Clear-Site-Data"] = '"cookies", "storage"'


def as_json(content: Any, status: int = 200) -> Response:
    """A JSON reply that no cache keeps."""
    body = json.dumps(content, separators=(",", ":"), allow_nan=False)
    return Response(
        body, status, headers={"Cache-Control": "no-store"}, media_type="application/json"
    )
