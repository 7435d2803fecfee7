"""The time of an emulated cell: the world is stepped in real time on the event loop of the emulators."""

from __future__ import annotations

import asyncio
import heapq
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from itertools import count

from robots.sim.world.sim_world import SimWorld

# Sockets and controllers get their turn after so much time of the world.
_TURN_S = 0.004
# A world that is later than that does not catch up: its time stands still meanwhile, and so do the controllers.
_MOST_LATE_S = 0.1


class WorldTime:
    """Implements `PlantClock`; the only one who steps the world.

    Attributes:
        late_s: By how much it is behind real time, because the machine was too slow.
    """

    def __init__(self, world: SimWorld) -> None:
        self._world = world
        self._reached_s = asyncio.get_running_loop().time()
        self.late_s = 0.0
        self._sleepers: list[tuple[float, int, asyncio.Future[None]]] = []
        self._numbers = count()

    def now_s(self) -> float:
        """Return the time of the world, which counts from that of the event loop at its start."""
        return self._reached_s

    async def sleep_until(self, time_s: float) -> None:
        """Return once the world has reached this time."""
        if time_s <= self._reached_s:
            await asyncio.sleep(0.0)
            return
        woken: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        heapq.heappush(self._sleepers, (time_s, next(self._numbers), woken))
        await woken

    @asynccontextmanager
    async def passing(self) -> AsyncGenerator[asyncio.Task[None]]:
        """Step the world, which is open, in a task; its end inside the block is an error."""
        stepping = asyncio.get_running_loop().create_task(self.run(), name="time of the world")
        try:
            yield stepping
        finally:
            stepping.cancel()
            await asyncio.wait((stepping,))

    async def run(self) -> None:
        """Step the world until cancelled."""
        loop = asyncio.get_running_loop()
        while True:
            behind_s = loop.time() - self.late_s - self._reached_s
            if behind_s > _MOST_LATE_S:
                self.late_s += behind_s - _MOST_LATE_S
            await asyncio.sleep(max(0.0, _TURN_S - behind_s))
            self._step_to(self._reached_s + _TURN_S)

    def _step_to(self, until_s: float) -> None:
        while self._reached_s < until_s:
            self._reached_s = self._world.advance(until_s)
        while self._sleepers and self._sleepers[0][0] <= self._reached_s:
            woken = heapq.heappop(self._sleepers)[2]
            if not woken.done():
                woken.set_result(None)
