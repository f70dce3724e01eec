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

from app import answering
from app.answering import Reply, Standing
from app.deps import PATHS, as_json, participant_at, services, token_of
from app.errors import InvalidInput
from app.schemas import Answered, Logged, Message, Played, Stopped
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
    token, at = token_of(request), services(request)

    def find(connection: Connection) -> Standing | None:
        participant = answering.participant_at_trial(connection, token)
        if participant.step != Step.TRIALS:
            return None
        return answering.standing(at.study, participant)

    return as_json(_state(at.study, await at.database.read(find)))


async def log(request: Request) -> Response:
    """Events that no answer carries."""
    message, at, token = await _message(request, Logged), services(request), token_of(request)
    await at.database.write(lambda c: answering.logged(c, at.study, token, message))
    return as_json({})


def _route(moment: str, model: type[M], happen: "Happen[M]") -> Route:
    """The route to which the page sends one moment of a trial."""

    async def endpoint(request: Request) -> Response:
        message, at, token = await _message(request, model), services(request), token_of(request)
        index = request.path_params["index"]
        reply = await at.database.write(lambda c: happen(c, at.study, token, index, message))
        state = _state(at.study, reply.standing)
        return as_json({"repeated": reply.repeated, **state, "next": _END if reply.done else None})

    return Route(f"/api/trials/{{index:int}}/{moment}", endpoint, methods=["POST"])


_END = PATHS[Step.COMPLETED]

routes = [
    Route("/api/practice", practice),
    Route("/api/trial", trial),
    Route("/api/events", log, methods=["POST"]),
    _route("played", Played, answering.played),
    _route("stopped", Stopped, answering.stopped),
    _route("answered", Answered, answering.answered),
]


async def _message(request: Request, model: type[M]) -> M:
    try:
        return model.model_validate_json(await request.body())
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"]) or "body"
        raise InvalidInput(f"{where}: {first['msg']}, came {str(first['input'])[:80]!r}") from error


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
            "ticket": standing.ticket,
            "playback": _playback(study, standing.stimulus, standing.step_ms, standing.lead_in_ms),
        },
        "next": None,
    }


def _playback(study: Study, stimulus: Stimulus, step_ms: int, lead_in_ms: int) -> dict[str, Any]:
    """What the page needs to play a stimulus."""
    return {**study.picture(stimulus), "step_ms": step_ms, "lead_in_ms": lead_in_ms}
