"""Order among bots on the way at once: they consent and are dealt places by their numbers.

So the same seed deals the same places, however many are on the way at once.
"""

import asyncio


class Line:
    """Lets bots past one point in the order of their places, 0, 1, 2, ..."""

    def __init__(self) -> None:
        self._next = 0
        self._moved = asyncio.Condition()

    async def wait(self, place: int) -> None:
        """Wait until all before have gone past."""
        async with self._moved:
            await self._moved.wait_for(lambda: self._next >= place)

    async def go_past(self, place: int) -> None:
        """Be past, in one's turn; once more changes nothing."""
        await self.wait(place)
        async with self._moved:
            self._next = max(self._next, place + 1)
            self._moved.notify_all()


class Turn:
    """One bot's place in the two lines: to consent, which numbers people, and to be dealt."""

    def __init__(self, consenting: Line, dealing: Line, place: int) -> None:
        self._consenting = consenting
        self._dealing = dealing
        self._place = place

    async def to_consent(self) -> None:
        """Wait until those before have consented or gone."""
        await self._consenting.wait(self._place)

    async def consented(self) -> None:
        """Let the next one consent."""
        await self._consenting.go_past(self._place)

    async def to_be_dealt(self) -> None:
        """Wait until those before have been dealt a place or gone."""
        await self._dealing.wait(self._place)

    async def dealt(self) -> None:
        """Let the next one be dealt a place; whoever is gone lets them too."""
        await self.consented()
        await self._dealing.go_past(self._place)
