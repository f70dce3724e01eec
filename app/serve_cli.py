"""The command `serve`."""

import errno
import socket
from typing import Annotated

import typer

from app.errors import AppError

commands = typer.Typer()


class NoListener(AppError):
    """The address or port cannot be listened on."""


@commands.command()
def serve(
    host: Annotated[str, typer.Option(help="Address to listen on.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port; 0 takes a free one.")] = 8000,
) -> None:
    """Serve the study to participants; answers go to the file GOALGUESS_DATABASE_URL names.

    Example: GOALGUESS_DATABASE_URL=sqlite:///study.sqlite goalguess serve --port 8000
    """
    from contextlib import closing

    import uvicorn

    from app.main import create_app
    from app.opening import open_database, start_line, start_warnings
    from app.recruits import people_without_id
    from app.serving import StudyConfig
    from app.settings import load_settings
    from app.study import load_study

    settings = load_settings()
    app = create_app(settings)
    study = load_study(settings)
    is_new = not settings.database_file.exists()
    # What can go wrong is tried first, so that it is told in one line: the file and the port.
    with closing(open_database(study)) as database:
        answers = start_line(study, is_new, database)
        without_id = database.read_now(people_without_id)
    with _listen(host, port) as listener:
        typer.echo(f"{answers} Stop with Ctrl+C.")
        shown = f"[{host}]" if ":" in host else host
        address = f"http://{shown}:{listener.getsockname()[1]}{settings.root_path}/"
        typer.echo(f"The study is at {address}")
        if settings.study_open:
            typer.echo(f"To try it, left out of the data: {address}?preview=1")
        else:
            typer.echo("It is closed: nobody new can begin (GOALGUESS_STUDY_OPEN).")
        for gap in settings.gaps:
            typer.echo(f"Not set: {gap}", err=True)
        for warning in filter(None, (*settings.doubts, *start_warnings(study), without_id)):
            typer.echo(warning, err=True)
        uvicorn.Server(StudyConfig(app, settings)).run(sockets=[listener])


def _listen(host: str, port: int) -> socket.socket:
    """A socket that takes connections; NoListener says what hinders it."""
    if not host:
        raise NoListener("--host: expected an address of this machine, came none; all are 0.0.0.0")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host, port), family=family)
    except (OSError, UnicodeError) as error:
        code = error.errno if isinstance(error, OSError) else None
        if code in _PORT:
            raise NoListener(f"--port {port}: expected a free port, {_PORT[code]}") from error
        raise NoListener(f"--host: expected an address of this machine, came {host!r}") from error


_PORT = {errno.EADDRINUSE: "this one is in use", errno.EACCES: "this one only root may take"}
