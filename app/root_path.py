"""The study under a path of its host, like /study: one place knows about it on each side.

A proxy may pass the path on or take it off; from here on every request has it. What goes out gets
it from `Pages.url` in pages, from `see` in redirects and from static/api.js in requests.
"""

from collections.abc import Iterable

from starlette.routing import BaseRoute, Mount, Route
from starlette.types import ASGIApp, Receive, Scope, Send

from app.errors import InvalidInput


class UnderRootPath:
    """Gives every request the study's path, as Starlette's routes and mounts expect it."""

    def __init__(self, app: ASGIApp, root_path: str) -> None:
        self.app = app
        self.root_path = root_path

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one request."""
        if self.root_path and scope["type"] == "http":
            # In place: the handler of crashes, which is outside of this, sees it too.
            scope["root_path"] = self.root_path
            scope["path"] = self.root_path + (own_path(scope) or "/")
        await self.app(scope, receive, send)


def root_path(scope: Scope) -> str:
    """The study's path on its host; empty for the whole host."""
    path: str = scope.get("app_root_path", scope.get("root_path", ""))
    return path


def own_path(scope: Scope) -> str:
    """A request's path within the study."""
    path: str = scope["path"]
    root = root_path(scope)
    within = path == root or path.startswith(f"{root}/")
    return path[len(root) :] if within else path


def require_apart(root_path: str, routes: Iterable[BaseRoute]) -> None:
    """InvalidInput where the study's path could be taken for one of its own pages."""
    first = root_path.split("/")[1] if root_path else None
    ours = {route.path.split("/")[1] for route in routes if isinstance(route, Route | Mount)}
    if first in ours - {""}:
        raise InvalidInput(
            f"GOALGUESS_ROOT_PATH: expected a path that is none of the study's own, came "
            f"{root_path!r}; not possible are {', '.join(sorted(ours - {''}))}"
        )
