"""The latest stop of the cell for pages: what it did at once, and what arms hold and where they are as it changes."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from engine.project import CellStop, Session

PERIOD_S = 0.25
"""How often arms and tools are looked at while there is a stop; without one nothing is."""


class CellStopWatch:
    """Keeps `stop` up to date.

    Args:
        backend: The engine.
        changed: Called when `stop` has changed.
        period_s: Period of looking at arms and tools.
    """

    def __init__(self, backend: Session, *, changed: Callable[[], None], period_s: float = PERIOD_S) -> None:
        self._backend = backend
        self._changed = changed
        self._period_s = period_s
        self._due = asyncio.Event()
        self._task: asyncio.Task[None] | None = None
        self._unsubscribe: Callable[[], None] | None = None
        self.stop: CellStop | None = None
        """The latest stop; None if there is none."""

    def open(self) -> None:
        """Begin to follow the stops of the session, on its event loop."""
        self._unsubscribe = self._backend.recovery.when_changed(self._look_now)
        self._look_now()

    async def close(self) -> None:
        """End it."""
        if self._unsubscribe is not None:
            self._unsubscribe()
            self._unsubscribe = None
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait({self._task})
            self._task = None

    def _look_now(self) -> None:
        self._due.set()
        is_running = self._task is not None and not self._task.done()
        if self._backend.recovery.is_stopped and not is_running:
            self._task = asyncio.create_task(self._follow(), name="stop-watch")

    async def _follow(self) -> None:
        """Look until the stop is forgotten."""
        while True:
            self._due.clear()
            now = await self._backend.recovery.state()
            if now != self.stop:
                self.stop = now
                self._changed()
            if now is None:
                return
            try:
                async with asyncio.timeout(self._period_s):
                    await self._due.wait()
            except TimeoutError:
                continue
