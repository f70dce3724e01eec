"""Pages: the templates and static files, found in a checkout and in an installed package alike."""

from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from fastapi.responses import HTMLResponse
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from starlette.middleware.gzip import GZipMiddleware
from starlette.responses import Response
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp, Scope

from app.study import Study


def resources(name: str) -> Path:
    """The folder `templates` or `static`: inside the package once installed, else beside it."""
    package = Path(__file__).parent
    installed = package / name
    return installed if installed.is_dir() else package.parent / name


class Pages:
    """Renders templates for one study; static addresses carry the hash of all static files."""

    def __init__(self, study: Study) -> None:
        self._root = study.settings.root_path
        self.static_root = f"/static/{_digest(resources('static'))}"
        self._templates = Environment(
            loader=FileSystemLoader(resources("templates")),
            autoescape=True,
            undefined=StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
        )
        self._templates.globals.update(
            study=study,
            url=self.url,
            static_url=lambda name: self.url(f"{self.static_root}/{name}"),
        )

    def url(self, path: str) -> str:
        """The address of a page of ours, under the study's path on its host."""
        return self._root + path

    def render(
        self,
        template: str,
        context: Mapping[str, Any],
        participant: str | None = None,
        pilot: str | None = None,
        can_withdraw: bool = False,
        status: int = 200,
    ) -> HTMLResponse:
        """A page; `participant` is the pseudonym that keys what the browser stores.

        `pilot` is the stream of a pilot, to whom every page says that they are one.
        """
        # Whose page it is: the session may be another one's when the link is followed.
        withdraw_url = self.url(f"/withdraw?participant={participant}") if can_withdraw else None
        html = self._templates.get_template(template).render(
            participant=participant, pilot=pilot, withdraw_url=withdraw_url, **context
        )
        return HTMLResponse(html, status, headers={"Cache-Control": "no-store"})


def static_app() -> ASGIApp:
    """Serves the static files compressed; their hashed addresses may be cached for good."""
    return GZipMiddleware(_ImmutableFiles(directory=resources("static")), minimum_size=500)


class _ImmutableFiles(StaticFiles):
    async def get_response(self, path: str, scope: Scope) -> Response:
        response = await super().get_response(path, scope)
        if response.status_code == 200:
            response.headers["Cache-Control"] = "public, max-age=31536000, immutable"
        return response


def _digest(folder: Path) -> str:
    content = sha256()
    for file in sorted(folder.rglob("*")):
        if file.is_file():
            content.update(file.name.encode() + b"\0" + file.read_bytes())
    return content.hexdigest()[:12]
