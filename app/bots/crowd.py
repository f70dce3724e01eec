"""Many simulated participants at once, against a running server or an application of our own."""

import asyncio
import ssl
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, replace

import numpy as np
from httpx2 import ASGITransport, AsyncClient, InvalidURL, TransportError

from app.bots.bot import Bot
from app.bots.browser import Browser, NoServer
from app.bots.kinds import Mix, deal_kinds
from app.bots.turns import Line, Turn
from app.bots.visit import Visit
from app.errors import StudyClosed
from app.main import create_app
from app.schemas import Answered
from app.settings import Settings

NewClient = Callable[[], AsyncClient]

TIMEOUT_S = 30


@dataclass(frozen=True)
class Outcome:
    """A bot, the words at which its visit ended, and the answers acknowledged, by round."""

    bot: Bot
    ended: str
    answers: dict[int, Answered]

    def after(self, before: "Outcome") -> "Outcome":
        """This outcome with the answers of an earlier visit."""
        return replace(self, answers={**before.answers, **self.answers})


def draw_bots(participants: int, seed: int, mix: Mix) -> list[Bot]:
    """The bots of a seed: the same ones each time, each with a generator of its own."""
    rng, *streams = np.random.default_rng(seed).spawn(participants + 1)
    kinds = deal_kinds(mix, participants, rng)
    numbered = enumerate(zip(kinds, streams, strict=True), 1)
    return [Bot.draw(seed, number, kind, stream) for number, (kind, stream) in numbered]


async def simulate(
    new_client: NewClient,
    bots: Sequence[Bot],
    at_once: int,
    finished: Callable[[Outcome], None] = lambda _outcome: None,
) -> list[Outcome]:
    """Let the bots take part, at most so many at once; those who return do so after all others.

    `finished` hears of each bot when it is done; outcomes come in the order of the bots.
    """
    outcomes = await _all_visit(new_client, bots, at_once, finished)
    away = [bot for bot in bots if bot.returns_later]
    back = await _all_visit(
        new_client, [replace(bot, leaves_at=None) for bot in away], at_once, finished
    )
    returned = {outcome.bot.number: outcome for outcome in back}
    return [returned[o.bot.number].after(o) if o.bot.returns_later else o for o in outcomes]


async def _all_visit(
    new_client: NewClient,
    bots: Sequence[Bot],
    at_once: int,
    finished: Callable[[Outcome], None],
) -> list[Outcome]:
    slots = asyncio.Semaphore(at_once)
    consenting, dealing = Line(), Line()

    async def one(place: int, bot: Bot) -> Outcome:
        async with slots, new_client() as client:
            visit = Visit(bot, Browser(client), Turn(consenting, dealing, place))
            ended = await visit.take_part()
        outcome = Outcome(bot, ended, visit.rounds.answers)
        if not bot.returns_later:
            finished(outcome)
        return outcome

    return await asyncio.gather(*(one(place, bot) for place, bot in enumerate(bots)))


def run(
    bots: Sequence[Bot],
    where: str | Settings,
    at_once: int,
    finished: Callable[[Outcome], None] = lambda _outcome: None,
) -> list[Outcome]:
    """Simulate at the address of a running study, or in this process under settings."""
    entry = _server_at(where) if isinstance(where, str) else _own_application(where)

    async def enter() -> list[Outcome]:
        async with entry as new_client:
            await _require_open(new_client)
            return await simulate(new_client, bots, at_once, finished)

    return asyncio.run(enter())


async def _require_open(new_client: NewClient) -> None:
    async with new_client() as client:
        reply = await client.get("/")
    if reply.status_code == StudyClosed.status:
        raise StudyClosed(
            "expected a study that takes participants, this one is closed: GOALGUESS_STUDY_OPEN is "
            "false where it runs"
        )


@asynccontextmanager
async def _server_at(url: str) -> AsyncIterator[NewClient]:
    # Made once: it takes longer than a whole visit.
    trust = ssl.create_default_context()

    def new_client() -> AsyncClient:
        return AsyncClient(base_url=url, verify=trust, follow_redirects=True, timeout=TIMEOUT_S)

    try:
        async with new_client() as client:
            await client.get("/")
    except (TransportError, InvalidURL) as error:
        raise NoServer(f"--url {url}: expected the address of a running study: {error}") from error
    yield new_client


@asynccontextmanager
async def _own_application(settings: Settings) -> AsyncIterator[NewClient]:
    app = create_app(settings)
    address = f"http://simulated{settings.root_path}"
    async with app.router.lifespan_context(app):
        transport = ASGITransport(app=app)
        yield lambda: AsyncClient(transport=transport, base_url=address, follow_redirects=True)
