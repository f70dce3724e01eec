"""What the trial page fetches and sends, as JSON: parse, call, reply.

Plain Starlette routes: they are most of what a participant requests, and FastAPI's own layers
would double their cost.
"""

from collections.abc import Callable
from typing import Any, TypeVar

from pydantic import ValidationError
from sqlalchemy import Connection
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from app import answering, enrolment
from app.answering import Reply, Standing
from app.deps import PATHS, as_json, participant_at, services, token_of
from app.errors import InvalidInput, Moved, NoSuchTrial
from app.schemas import Answered, Logged, Message, Played, Stopped, read_message
from app.steps import Step
from app.study import Study
from policies import Stimulus

M = TypeVar("M", bound=Message)
Happen = Callable[[Connection, Study, str | None, int, M], Reply]


async def practice(request: Request) -> Response:
    """The practice animation."""
    await participant_at(request, Step.PRACTICE)
    study = services(request).study
    settings = study.settings
    return as_json(_playback(study, study.pool.practice, settings.step_ms, settings.lead_in_ms))


async def trial(request: Request) -> Response:
    """The trial the participant is at."""
    find, at = _find(request), services(request)
    return as_json(_state(at.study, await at.database.read(find)))


async def place(request: Request) -> Response:
    """A new place for whoever lost theirs; then the trial they are at."""
    find, at = _find(request), services(request)
    token, page = token_of(request), request.query_params.get("participant")

    def deal_and_find(connection: Connection) -> Standing | None:
        enrolment.deal_again(connection, at.study, token, page)
        return find(connection)

    return as_json(_state(at.study, await at.database.write(deal_and_find)))


async def log(request: Request) -> Response:
    """Events that no answer carries."""
    message, at, token = await _message(request, Logged), services(request), token_of(request)
    await at.database.write(lambda c: answering.logged(c, at.study, token, message))
    return as_json({})


def _route(moment: str, model: type[M], happen: "Happen[M]") -> Route:
    """The route to which the page sends one moment of a trial."""

    async def endpoint(request: Request) -> Response:
        index, at, token = _index(request), services(request), token_of(request)
        message = await _message(request, model)
        try:
            reply = await at.database.write(lambda c: happen(c, at.study, token, index, message))
        except Moved:
            if isinstance(message, Played):
                played = message
                await at.database.write(
                    lambda c: answering.played_elsewhere(c, at.study, token, index, played)
                )
            raise
        state = _state(at.study, reply.standing)
        return as_json({"repeated": reply.repeated, **state, "next": _END if reply.done else None})

    return Route(f"/api/trials/{{index}}/{moment}", endpoint, methods=["POST"])


_END = PATHS[Step.COMPLETED]

routes = [
    Route("/api/practice", practice),
    Route("/api/trial", trial),
    Route("/api/place", place, methods=["POST"]),
    Route("/api/events", log, methods=["POST"]),
    _route("played", Played, answering.played),
    _route("stopped", Stopped, answering.stopped),
    _route("answered", Answered, answering.answered),
]


async def _message(request: Request, model: type[M]) -> M:
    try:
        return read_message(model, await request.body())
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"]) or "body"
        raise InvalidInput(f"{where}: {first['msg']}, came {str(first['input'])[:80]!r}") from error


def _find(request: Request) -> Callable[[Connection], Standing | None]:
    """Finds the trial of the participant whose page asks; None when the trials are not due."""
    token, study = token_of(request), services(request).study
    page = request.query_params.get("participant")

    def find(connection: Connection) -> Standing | None:
        participant = answering.participant_at_trial(connection, token, page)
        return answering.standing(study, participant) if participant.step == Step.TRIALS else None

    return find


def _index(request: Request) -> int:
    """The trial's number in the path; no page of ours asks for one of four digits."""
    digits = request.path_params["index"]
    if not (digits.isascii() and digits.isdigit() and len(digits) < 4):
        raise NoSuchTrial("Expected the number of a trial.")
    return int(digits)


def _state(study: Study, standing: Standing | None) -> dict[str, Any]:
    if standing is None:
        return {"trial": None, "next": _END}
    return {
        "trial": {
            "index": standing.index,
            "of": study.trials,
            "phase": standing.phase,
            "position_ms": standing.position_ms,
            "stop_time_ms": standing.stop_time_ms,
            "press_ms": standing.press_ms,
            "ticket": standing.ticket,
            "playback": _playback(study, standing.stimulus, standing.step_ms, standing.lead_in_ms),
        },
        "next": None,
    }


def _playback(study: Study, stimulus: Stimulus, step_ms: int, lead_in_ms: int) -> dict[str, Any]:
    """What the page needs to play a stimulus."""
    return {**study.picture(stimulus), "step_ms": step_ms, "lead_in_ms": lead_in_ms}
