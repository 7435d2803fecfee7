"""One switch of a tool: outputs are set, and then its time passes."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

from engine.errors import RobotError
from robots.port import MotionEnd, MotionReport


class SwitchMotion:
    """Implements `robots.port.Motion`.

    An output that is set takes effect: holding and cancelling change how the end is reported, and do not stop the tool
    between open and closed.

    Args:
        switch: Sets the outputs and returns when they are confirmed; raises RobotError.
        duration_s: Time that the tool takes after that.
    """

    def __init__(self, switch: Callable[[], Awaitable[None]], *, duration_s: float) -> None:
        self._duration_s = duration_s
        self._begun_s: float | None = None
        self._canceled = False
        self._loop = asyncio.get_running_loop()
        self._execution = self._loop.create_task(self._execute(switch), name="switching a tool")

    @property
    def ended(self) -> bool:
        """True once it has a report."""
        return self._execution.done()

    @property
    def progress(self) -> float:
        """Share of its time that has passed."""
        if self._begun_s is None:
            return 0.0
        passed_s = self._loop.time() - self._begun_s
        return 1.0 if self.ended or passed_s >= self._duration_s else passed_s / self._duration_s

    async def report(self) -> MotionReport:
        """Wait for the end; cancelling one waiter affects neither the motion nor other waiters."""
        return await asyncio.shield(self._execution)

    async def hold(self) -> None:
        """Return when the tool is at rest, which is at the end."""
        await self.report()

    async def resume(self) -> None:
        """Do nothing: it was not stopped."""

    def cancel(self) -> None:
        """Let `report` return CANCELED once the time has passed."""
        self._canceled = True

    async def _execute(self, switch: Callable[[], Awaitable[None]]) -> MotionReport:
        try:
            await switch()
        except RobotError as error:
            return MotionReport(end=MotionEnd.FAILED, reason=str(error))
        self._begun_s = self._loop.time()
        await asyncio.sleep(self._duration_s)
        return MotionReport(end=MotionEnd.CANCELED if self._canceled else MotionEnd.REACHED)
