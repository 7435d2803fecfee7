"""One motion of a tool that a link drives: its waiters, and how it is held, resumed, cancelled and ended."""

from __future__ import annotations

import asyncio
from abc import ABC, abstractmethod

from engine.errors import RobotError
from robots.port import MotionEnd, MotionReport


class DeviceMotion(ABC):
    """Implements `robots.port.Motion`; a subclass sends the commands of its device and follows its readings.

    It calls `_rest` when the tool is at rest after `_send_stop`, and `_finish` when the motion has ended.
    """

    def __init__(self) -> None:
        self._end: asyncio.Future[MotionReport] = asyncio.get_running_loop().create_future()
        self._held: asyncio.Future[None] | None = None
        self._stopping = False
        self._canceled = False
        self._canceled_as = MotionReport(end=MotionEnd.CANCELED)

    @property
    def ended(self) -> bool:
        """True once it has a report."""
        return self._end.done()

    @property
    def progress(self) -> float:
        """Share of the distance passed; 1 at the end."""
        if self._end.done() and self._end.result().end is MotionEnd.REACHED:
            return 1.0
        return self._passed_share()

    async def report(self) -> MotionReport:
        """Wait for the end; cancelling one waiter affects neither the motion nor other waiters."""
        return await asyncio.shield(self._end)

    async def hold(self) -> None:
        """Stop and return when at rest, or when the motion has ended or been resumed."""
        if self.ended:
            return
        if self._held is None:
            self._held = asyncio.get_running_loop().create_future()
        held = self._held
        self._stop()
        await asyncio.shield(held)

    async def resume(self) -> None:
        """Move on to the same goal."""
        if self.ended or self._canceled:
            return
        held, self._held = self._held, None
        self._stopping = False
        self._send_go()
        if held is not None and not held.done():
            held.set_result(None)

    def cancel(self) -> None:
        """Stop; `report` then returns CANCELED once the tool is at rest."""
        if not self.ended and not self._canceled:
            self._canceled = True
            self._stop()

    def abort(self, reason: str) -> None:
        """Stop; `report` then returns FAILED with `reason` once the tool is at rest."""
        self._canceled_as = MotionReport(end=MotionEnd.FAILED, reason=reason)
        self.cancel()

    def fail(self, reason: str, *, at_rest: bool = True) -> None:
        """End as failed."""
        self._finish(MotionReport(end=MotionEnd.FAILED, reason=reason, at_rest=at_rest))

    @abstractmethod
    def _passed_share(self) -> float:
        """Return the share of the distance passed, 0 to 1."""

    @abstractmethod
    def _send_go(self) -> None:
        """Move towards the goal."""

    @abstractmethod
    def _send_stop(self) -> None:
        """Stop where the tool is; what it holds stays held."""

    def _stop(self) -> None:
        if not self._stopping:
            self._stopping = True
            self._send_stop()

    def _rest(self) -> None:
        if self._canceled:
            self._finish(self._canceled_as)
        elif self._held is not None and not self._held.done():
            self._held.set_result(None)

    def _watch(self, written: asyncio.Future[float]) -> None:
        """Fail when a command is not acknowledged: nobody knows whether it has arrived."""
        written.add_done_callback(self._acknowledge)

    def _acknowledge(self, written: asyncio.Future[float]) -> None:
        error = written.exception()
        if isinstance(error, RobotError):
            self.fail(f"a command was not acknowledged: {error.message}", at_rest=False)
        elif error is not None:
            raise error
        else:
            self._acknowledged(written.result())

    @abstractmethod
    def _acknowledged(self, at_s: float) -> None:
        """Note that the last command was acknowledged."""

    def _finish(self, report: MotionReport) -> None:
        if not self._end.done():
            self._end.set_result(report)
        if self._held is not None and not self._held.done():
            self._held.set_result(None)
