"""The application: `create_app(settings)` puts the parts together."""

import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from fastapi import FastAPI, Request
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import Response

from app import VERSION, health, participant, trials_api
from app.deps import (
    OWN_PAGE,
    AtAnotherStep,
    Services,
    as_json,
    page,
    recognise,
    see,
    way_on,
)
from app.errors import (
    AppError,
    BadLink,
    DatabaseUnavailable,
    Moved,
    OtherParticipant,
    StudyClosed,
    WrongStep,
)
from app.limits import Moderation
from app.opening import open_database
from app.pages import Pages, static_app
from app.root_path import UnderRootPath, own_path, require_apart
from app.security import HEADERS, OwnPagesOnly, SecurityHeaders
from app.settings import Settings
from app.study import load_study

log = logging.getLogger("goalguess")


def create_app(settings: Settings) -> FastAPI:
    """The study as an ASGI application; its database is opened when it starts."""
    study = load_study(settings)
    pages = Pages(study)

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        database = open_database(study)
        consents = Moderation(settings.consents_per_minute)
        app.state.services = Services(study, database, pages, consents)
        # Its lines would hold the invitation links, and with them people's ids.
        logging.getLogger("uvicorn.access").disabled = True
        yield
        database.close()

    app = FastAPI(
        title="Goalguess",
        version=VERSION,
        lifespan=lifespan,
        docs_url=None,
        redoc_url=None,
        openapi_url=None,
        redirect_slashes=False,  # it would redirect to whatever host a request names
    )
    app.router.routes.extend([*trials_api.routes, *health.routes])
    app.include_router(participant.router)
    app.mount(pages.static_root, static_app(), name="static")
    require_apart(settings.root_path, [*app.routes, *participant.router.routes])
    app.add_middleware(OwnPagesOnly, refuse=render_error)
    app.add_middleware(SecurityHeaders)
    app.add_middleware(UnderRootPath, root_path=settings.root_path)
    app.add_exception_handler(AppError, render_error)
    app.add_exception_handler(HTTPException, _render_http_error)
    app.add_exception_handler(ClientDisconnect, _nobody_there)
    app.add_exception_handler(Exception, _render_crash)
    return app


def render_error(request: Request, error: Exception) -> Response:
    """The one place where errors become replies: a page, or JSON for the trial page."""
    if not isinstance(error, AppError):
        raise error
    if isinstance(error, DatabaseUnavailable):
        log.error("%s", error)
    reply = _render(request, error)
    if error.retry_after_s is not None:
        reply.headers["Retry-After"] = str(error.retry_after_s)
    return reply


def _render(request: Request, error: AppError) -> Response:
    if own_path(request.scope).startswith("/api/"):
        content = {"error": {"code": error.code, "message": error.shown}}
        return as_json(content, error.status)
    if isinstance(error, WrongStep):
        return see(error.path if isinstance(error, AtAnotherStep) else OWN_PAGE)
    if error.status < 500:
        recognise(request)
    if isinstance(error, Moved | OtherParticipant):
        return page(request, f"{error.code}.html", status=error.status)
    if isinstance(error, StudyClosed):
        return page(request, "closed.html", {"message": str(error)}, status=error.status)
    if isinstance(error, BadLink):
        return page(request, "bad_link.html", {"message": str(error)}, status=error.status)
    context = {"status": error.status, "message": error.shown, "way_on": way_on(request, error)}
    return page(request, "error.html", context, status=error.status)


def _nobody_there(_request: Request, _error: Exception) -> Response:
    """Whoever sent the request has gone before it was complete: it is no failure of ours."""
    return Response(status_code=408)


def _render_http_error(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    refusal = AppError("There is no such page." if error.status_code == 404 else error.detail)
    refusal.status = error.status_code
    return render_error(request, refusal)


def _render_crash(request: Request, error: Exception) -> Response:
    log.exception("%s %s failed", request.method, own_path(request.scope), exc_info=error)
    reply = render_error(request, AppError("Something went wrong on our side. Please try again."))
    # The server closes after a crash; who does not know would lose the next request.
    reply.headers.update({**HEADERS, "Connection": "close"})
    return reply
