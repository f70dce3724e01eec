"""A simulated participant's way through the study: wherever the server leads, until the end."""

from collections.abc import Awaitable, Callable

from app.bots.bot import CONSENT, Bot
from app.bots.browser import Browser, Page, Refused
from app.bots.forms import Form
from app.bots.kinds import Kind
from app.bots.rounds import TROUBLE, Rounds
from app.bots.turns import Turn
from app.questions import CONTROL_RIGHT

MOST_PAGES = 100
LEFT = "left"
ELSEWHERE = ("wrong_step", "place_returned")
"""Refusals after which our trial page loads itself again."""


class _Left(Exception):
    """The bot closed its browser, at a place in words."""


class Visit:
    """One bot in one browser; `rounds.answers` is what the server acknowledged."""

    def __init__(self, bot: Bot, browser: Browser, turn: Turn) -> None:
        self.bot = bot
        self.browser = browser
        self.turn = turn
        self.rounds = Rounds(bot, browser, self._reach)

    async def take_part(self) -> str:
        """Open the link and do what the pages ask; returns the last page's heading, or `LEFT`."""
        try:
            return await self._walk()
        except _Left as left:
            return str(left)
        finally:
            await self.turn.dealt()

    @property
    def _link(self) -> str:
        return f"/?PROLIFIC_PID={self.bot.recruiter_id}&simulated=1"

    async def _walk(self) -> str:
        act: dict[str, Callable[[Page], Awaitable[Page]]] = {
            CONSENT: self._consent,
            "/about-you": self._fill_in,
            "/instructions": self._fill_in,
            "/practice": self._practise,
            "/trial": self._play,
        }
        page = await self.browser.open(self._link)
        for _ in range(MOST_PAGES):
            if page.at_home:
                await self._reach(page.path)
            if page.path not in act or not page.at_home:
                return page.heading
            if self.bot.kind == Kind.RELOADING and self.bot.happens(TROUBLE):
                page = await self.browser.open(page.address)
            page = await act[page.path](page)
        raise AssertionError(f"{MOST_PAGES} pages and no end, the last one {page.path}")

    async def _consent(self, page: Page) -> Page:
        await self.turn.to_consent()
        following = await self._submit(page.form, {"decision": "yes"})
        await self.turn.consented()
        return following

    async def _fill_in(self, page: Page) -> Page:
        return await self._submit(page.form, page.form.fill_in(self.bot.rng))

    async def _practise(self, page: Page) -> Page:
        await self.browser.fetch("/api/practice")
        careless = self.bot.kind in (Kind.GUESSING, Kind.SPEEDING)
        answers = page.form.fill_in(self.bot.rng)
        if not careless and not self.bot.happens(self.bot.observer.lapse):
            answers["answer"] = CONTROL_RIGHT
        await self.turn.to_be_dealt()
        return await self._submit(page.form, answers)

    async def _play(self, page: Page) -> Page:
        await self.turn.dealt()
        try:
            await self.rounds.play(page)
        except Refused as refused:
            if refused.refusal not in ELSEWHERE:
                raise
        return await self.browser.open("/trial")

    async def _submit(self, form: Form, values: dict[str, str]) -> Page:
        if self.bot.kind in (Kind.DOUBLE_CLICKING, Kind.TWO_TABS):
            await self.browser.submit(form, values)
        return await self.browser.submit(form, values)

    async def _reach(self, moment: str) -> None:
        """Go, if this is the moment at which this bot does."""
        if moment != self.bot.leaves_at:
            return
        if self.bot.kind == Kind.WITHDRAWING:
            page = await self.browser.open("/withdraw")
            page = await self.browser.submit(page.form, {})
            raise _Left(page.heading)
        if moment == CONSENT:
            page = await self.browser.open(self._link)
            page = await self.browser.submit(page.form, {"decision": "no"})
            raise _Left(page.heading)
        raise _Left(LEFT)
