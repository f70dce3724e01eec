"""A proxy that shows a study under a path of its host, and nothing beside it."""

from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Receive, Scope, Send


class PrefixProxy:
    """Passes on what is under `prefix`, with it or without; all else is another site's."""

    def __init__(self, app: ASGIApp, prefix: str, strips: bool) -> None:
        self.app, self.prefix, self.strips = app, prefix, strips

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http":
            path = scope["path"]
            if path != self.prefix and not path.startswith(f"{self.prefix}/"):
                reply = PlainTextResponse("another site", 404)
                await reply(scope, receive, send)
                return
            if self.strips:
                scope = {**scope, "path": path.removeprefix(self.prefix) or "/"}
        await self.app(scope, receive, send)
