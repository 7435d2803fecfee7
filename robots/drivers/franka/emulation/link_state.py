"""What is wrong with the network of an emulated control cabinet."""

from __future__ import annotations

import asyncio


class LinkState:
    """Faults that the side channel switches, for the links of arm and hand alike."""

    def __init__(self) -> None:
        self.delay_s = 0.0
        self.is_cut = False
        self._alive = asyncio.Event()
        self._alive.set()

    @property
    def is_frozen(self) -> bool:
        """Whether connections stay open, and nothing is read or sent."""
        return not self._alive.is_set()

    def freeze(self) -> None:
        """Hang."""
        self._alive.clear()

    def restore(self) -> None:
        """End all faults."""
        self.is_cut, self.delay_s = False, 0.0
        self._alive.set()

    async def pass_on(self) -> None:
        """Wait as long as the network delays what is sent now."""
        await self._alive.wait()
        if self.delay_s:
            await asyncio.sleep(self.delay_s)
