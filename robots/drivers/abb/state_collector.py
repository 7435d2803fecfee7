"""Waits for the next state messages of a controller, for any number of callers at a time."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field

from robots.drivers.abb.state_transport import AbbReading
from robots.drivers.fresh_link import FreshReading

Readings = list[FreshReading[AbbReading]]


@dataclass(eq=False)
class _Wait:
    number: int
    done: asyncio.Future[None]
    readings: Readings = field(default_factory=Readings)


class StateCollector:
    """Hands each reading to all who wait for some."""

    def __init__(self) -> None:
        self._waits: list[_Wait] = []

    def take(self, reading: FreshReading[AbbReading]) -> None:
        """Take a reading."""
        for wait in self._waits:
            wait.readings.append(reading)
            if len(wait.readings) >= wait.number and not wait.done.done():
                wait.done.set_result(None)

    async def collect(self, number: int, *, limit_s: float) -> Readings:
        """Return this many readings from now on; raises TimeoutError."""
        wait = _Wait(number, asyncio.get_running_loop().create_future())
        self._waits.append(wait)
        try:
            async with asyncio.timeout(limit_s):
                await wait.done
        finally:
            self._waits.remove(wait)
        return wait.readings
