"""The rounds of a simulated participant: what the trial page would send, and what goes wrong.

Time is the bot's own: nobody waits for a robot that nobody sees.
"""

import asyncio
import uuid
from collections.abc import Awaitable, Callable
from typing import Any, TypeVar

from app.bots.bot import Bot
from app.bots.browser import Browser, Page, Refused
from app.bots.kinds import Kind
from app.bots.observer import Judgement, letters_of, watch_to_the_end
from app.schemas import Answered, EventType, Logged, LoggedEvent, Message, Played, Stopped
from app.steps import Phase

TROUBLE = 0.3
"""How often it befalls a kind that is named for it, at every occasion."""

SETTLING_MS = 1500.0
OUTAGE_MS = 60_000.0

M = TypeVar("M", bound=Message)
Trial = dict[str, Any]
State = dict[str, Any]
Reach = Callable[[str], Awaitable[None]]


class Rounds:
    """One visit to the trial page.

    `reach` is told each moment before it is lived; `answers` collects what the server
    acknowledged, by round.
    """

    def __init__(self, bot: Bot, browser: Browser, reach: Reach) -> None:
        self.answers: dict[int, Answered] = {}
        self._bot = bot
        self._browser = browser
        self._reach = reach
        self._participant: str | None = None
        self._judgements: dict[int, Judgement] = {}
        self._events: list[LoggedEvent] = []
        self._clock_ms = 0.0
        self._pauses = 0

    async def play(self, page: Page) -> None:
        """Play whatever rounds are left."""
        self._participant = page.participant
        state = await self._load()
        while state["trial"]:
            state = await self._live(state["trial"])

    async def _load(self) -> State:
        self._clock_ms = 0.0
        try:
            state = await self._browser.fetch(f"/api/trial?participant={self._participant}")
        except Refused as refused:
            if refused.refusal != "place_returned":
                raise
            state = await self._browser.ask(f"/api/place?participant={self._participant}")
        self._log("shown")
        return state

    async def _live(self, trial: Trial) -> State:
        phase = Phase(trial["phase"])
        await self._reach(f"{phase} {trial['index']}")
        if self._bot.kind == Kind.RELOADING and self._bot.happens(TROUBLE):
            return await self._reload(trial)
        act = {Phase.READY: self._play, Phase.MOVING: self._stop, Phase.ASKING: self._answer}
        return await act[phase](trial)

    async def _play(self, trial: Trial) -> State:
        self._pauses = 0
        self._log("played", after_ms=SETTLING_MS + trial["playback"]["lead_in_ms"])
        message = self._message(Played, ticket=trial["ticket"], device=self._bot.device)
        self._judgement(trial)
        reply = await self._tell(trial, "played", message)
        return reply if reply["trial"] else {"trial": {**trial, "phase": Phase.MOVING}}

    async def _stop(self, trial: Trial) -> State:
        judged = self._judgement(trial)
        self._log("stopped", after_ms=judged.stop_time_ms, stop_time_ms=judged.stop_time_ms)
        message = self._message(
            Stopped,
            stop_time_ms=judged.stop_time_ms,
            reached_end=judged.reached_end,
            pauses=self._pauses,
            paused_ms=self._pauses * SETTLING_MS,
            focus_losses=int(self._bot.rng.poisson(0.1)),
            frames_dropped=int(self._bot.rng.poisson(1)),
            reduced_motion=self._bot.device.reduced_motion,
        )
        reply = await self._tell(trial, "stopped", message)
        asking = {**trial, "phase": Phase.ASKING, "stop_time_ms": judged.stop_time_ms}
        return reply if reply["trial"] else {"trial": asking}

    async def _answer(self, trial: Trial) -> State:
        judged = self._judgement(trial)
        self._log("answered", after_ms=judged.confidence_latency_ms)
        message = self._message(
            Answered,
            stop_time_ms=trial["stop_time_ms"],
            guess=judged.guess,
            confidence=judged.confidence,
            guess_latency_ms=judged.guess_latency_ms,
            confidence_latency_ms=judged.confidence_latency_ms,
            pointer_moved=self._bot.device.pointer_type != "keyboard",
        )
        reply = await self._tell(trial, "answered", message)
        self.answers[trial["index"]] = message
        return reply

    async def _reload(self, trial: Trial) -> State:
        """Leave the page and load it again; a robot in motion stands still meanwhile."""
        seen_ms = None
        if trial["phase"] == Phase.MOVING:
            seen_ms = float(self._bot.rng.uniform(0, self._judgement(trial).stop_time_ms))
            self._log("interrupted", after_ms=seen_ms)
            self._pauses += 1
        leaving = self._message(Logged, trial_index=trial["index"], position_ms=seen_ms)
        await self._browser.send("/api/events", leaving)
        await self._browser.open("/trial")
        return await self._load()

    def _judgement(self, trial: Trial) -> Judgement:
        """What the bot does in this round; back in mid-motion, it lets the robot arrive."""
        if trial["index"] not in self._judgements:
            playback, rng = trial["playback"], self._bot.rng
            back = trial["phase"] == Phase.MOVING
            judged = watch_to_the_end(playback, rng) if back else self._bot.judge(playback)
            self._judgements[trial["index"]] = judged
        return self._judgements[trial["index"]]

    async def _tell(self, trial: Trial, what: str, message: Message) -> State:
        """Send a message, with what the bot's kind does to messages."""
        path, kind = f"/api/trials/{trial['index']}/{what}", self._bot.kind
        if kind == Kind.OFFLINE and self._bot.happens(TROUBLE):
            await self._browser.send(path, message)  # it arrives, but the reply gets lost
            self._log("retried", after_ms=OUTAGE_MS, path=path, attempt=1, status=0)
        if kind == Kind.DOUBLE_CLICKING:
            twice = (self._browser.send(path, message) for _ in range(2))
            reply, _same = await asyncio.gather(*twice)
        else:
            reply = await self._browser.send(path, message)
        if kind == Kind.TWO_TABS and self._bot.happens(TROUBLE):
            await self._browser.send(path, self._rival(message, letters_of(trial["playback"])))
        return reply

    def _rival(self, message: Message, letters: list[str]) -> Message:
        """What another tab would say of the same moment, under a key of its own."""
        other: dict[str, Any] = {}
        if isinstance(message, Stopped):
            other = {"stop_time_ms": 0.0, "reached_end": False}
        elif isinstance(message, Answered):
            other = {"guess": str(self._bot.rng.choice(letters))}
        return message.model_copy(update={**other, "key": self._key(), "events": []})

    def _message(self, model: type[M], **facts: Any) -> M:
        events, self._events = self._events, []
        return model(key=self._key(), participant=self._participant, events=events, **facts)

    def _key(self) -> str:
        return str(uuid.UUID(bytes=self._bot.rng.bytes(16), version=4))

    def _log(self, what: EventType, after_ms: float = 0.0, **details: Any) -> None:
        self._clock_ms = round(self._clock_ms + after_ms, 1)
        event = LoggedEvent(type=what, client_time_ms=self._clock_ms, details=details)
        self._events.append(event)
