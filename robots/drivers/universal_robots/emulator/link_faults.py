"""What is wrong with the network of an emulated controller, and which connections it has."""

from __future__ import annotations

import asyncio
from contextlib import suppress


class LinkFaults:
    """Faults that the side channel switches, for all ports but its own."""

    def __init__(self) -> None:
        self._delay_s = 0.0
        self._quick = asyncio.Event()
        self.garbles = False
        """Whether RTDE sends bytes that are no packets."""
        self._is_cut = False
        self._alive = asyncio.Event()
        self._alive.set()
        self._transports: set[asyncio.Transport] = set()

    @property
    def delay_s(self) -> float:
        """How late answers are."""
        return self._delay_s

    @delay_s.setter
    def delay_s(self, delay_s: float) -> None:
        self._delay_s = delay_s
        if delay_s > 0.0:
            self._quick.clear()
        else:
            self._quick.set()

    @property
    def is_frozen(self) -> bool:
        """Whether the controller hangs: connections stay open, and nothing is read or sent."""
        return not self._alive.is_set()

    @property
    def connections(self) -> int:
        """The number of open connections."""
        return len(self._transports)

    def admit(self, transport: asyncio.Transport) -> bool:
        """Note a new connection; returns False, with the connection dropped, while the link is cut."""
        if self._is_cut:
            transport.abort()
            return False
        self._transports.add(transport)
        if self.is_frozen:
            transport.pause_reading()
        return True

    def forget(self, transport: asyncio.Transport) -> None:
        """Note that a connection has ended."""
        self._transports.discard(transport)

    def freeze(self) -> None:
        """Hang."""
        self._alive.clear()
        for transport in self._transports:
            transport.pause_reading()

    def cut(self, *, stay: bool) -> None:
        """Drop all connections; refuse new ones until restored where the cut stays."""
        self._is_cut = stay
        for transport in tuple(self._transports):
            transport.abort()

    def restore(self) -> None:
        """End all faults."""
        self._is_cut, self.delay_s, self.garbles = False, 0.0, False
        self._alive.set()
        for transport in self._transports:
            transport.resume_reading()

    async def delayed(self) -> None:
        """Return as late as answers are, or as soon as the link is quick again."""
        if self._delay_s > 0.0:
            with suppress(TimeoutError):
                await asyncio.wait_for(self._quick.wait(), self._delay_s)

    async def alive(self) -> None:
        """Wait until the controller does not hang."""
        await self._alive.wait()
