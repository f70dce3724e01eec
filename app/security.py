"""What every request must pass and every reply carries, as plain ASGI middleware."""

import logging
import re
from collections.abc import Callable

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import Request
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.errors import AppError, ForeignOrigin, HostChanged, TooLarge

log = logging.getLogger("goalguess")

LARGEST_BODY = 64 * 1024

HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self'; connect-src 'self'; form-action 'self'; base-uri 'none'; "
    "frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    # Not no-referrer: with it browsers send `Origin: null` with our own forms.
    "Referrer-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
}


class SecurityHeaders:
    """Adds the security headers to every reply."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(HEADERS)
            await send(message)

        await self.app(scope, receive, send_with_headers)


class OwnPagesOnly:
    """Refuses writes that do not come from our own pages, and bodies larger than they send."""

    def __init__(self, app: ASGIApp, refuse: Callable[[Request, AppError], Response]) -> None:
        self.app = app
        self.refuse = refuse
        self.warned = False

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""
        if scope["type"] != "http" or scope["method"] in ("GET", "HEAD", "OPTIONS"):
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        try:
            _require_own_origin(headers)
            _require_size(headers.get("content-length", "0"))
        except AppError as error:
            if isinstance(error, HostChanged) and not self.warned:
                self.warned = True
                log.warning("Requests are refused. %s", error)
            await self.refuse(Request(scope), error)(scope, receive, send)
            return
        received = 0

        async def receive_counted() -> Message:
            nonlocal received
            message = await receive()
            received += len(message.get("body", b""))
            _require_size(str(received))
            return message

        await self.app(scope, receive_counted, send)


def _require_size(size: str) -> None:
    # More digits than a body can need are not even read as a number.
    if not re.fullmatch("[0-9]{1,9}", size) or int(size) > LARGEST_BODY:
        raise TooLarge(f"Expected a request that says its size, at most {LARGEST_BODY} bytes.")


def _require_own_origin(headers: Headers) -> None:
    origin, host = headers.get("origin"), headers.get("host", "")
    vouched = headers.get("sec-fetch-site") == "same-origin"
    sender = None if origin is None else origin.partition("://")[2]
    own = vouched if sender is None else sender == host
    if own:
        return
    if sender and (vouched or _without_port(sender) == _without_port(host)):
        raise HostChanged
    raise ForeignOrigin("This request did not come from a page of the study.")


def _without_port(host: str) -> str:
    return re.sub(r":[0-9]*$", "", host)
