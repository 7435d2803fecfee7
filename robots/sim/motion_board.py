"""The motions under way in a world, by number: the side that states' skills wait on."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from engine.errors import RobotError
from robots.control.motion_event import AnyMotionEvent, MotionFinished, MotionHeld, MotionResumed
from robots.port import MotionEnd, MotionReport
from robots.sim.commands import AnyCommand, Cancel, Hold, Resume

_Waiters = list[asyncio.Future[None]]


class SimMotion:
    """One motion in a simulated world; implements `robots.port.Motion`."""

    def __init__(
        self, number: int, *, send: Callable[[AnyCommand], None], progress: Callable[[], float | None]
    ) -> None:
        self.number = number
        self._send = send
        self._measure = progress
        self._last_progress = 0.0
        self._loop = asyncio.get_running_loop()
        self._end: asyncio.Future[MotionReport] = self._loop.create_future()
        self._held: _Waiters = []
        self._resumed: _Waiters = []

    @property
    def ended(self) -> bool:
        """True once it has a report."""
        return self._end.done()

    @property
    def progress(self) -> float:
        """Share of the trajectory's time passed, 0 to 1; frozen at the end."""
        if not self._end.done():
            measured = self._measure()
            if measured is not None:
                self._last_progress = measured
        return self._last_progress

    async def report(self) -> MotionReport:
        """Wait for the end; cancelling one waiter leaves the motion and the others alone."""
        return await asyncio.shield(self._end)

    async def hold(self) -> None:
        """Decelerate on the path and return when at rest, or when the motion ended meanwhile."""
        await self._ask(Hold(motion=self.number), self._held)

    async def resume(self) -> None:
        """Go on along the path and return when moving, or when the motion ended meanwhile."""
        await self._ask(Resume(motion=self.number), self._resumed)

    def cancel(self) -> None:
        """Ask to decelerate on the path; `report` then returns CANCELED once at rest."""
        if not self._end.done():
            self._send(Cancel(motion=self.number))

    async def _ask(self, command: AnyCommand, waiters: _Waiters) -> None:
        if self._end.done():
            return
        answer: asyncio.Future[None] = self._loop.create_future()
        waiters.append(answer)
        self._send(command)
        await answer

    def take(self, event: AnyMotionEvent) -> None:
        """Record what happened in the world."""
        match event:
            case MotionHeld() | MotionResumed():
                # Of a hold and a resume close together only the last is told; it answers both.
                _answer(self._held)
                _answer(self._resumed)
            case MotionFinished():
                self._last_progress = event.progress
                self.finish(MotionReport(end=MotionEnd(event.end), reason=event.reason))

    def finish(self, report: MotionReport) -> None:
        """End it; a second end is ignored."""
        if not self._end.done():
            self._end.set_result(report)
        _answer(self._held)
        _answer(self._resumed)


class MotionBoard:
    """Numbers motions and passes what happens in the world on to them; a `HostListener`."""

    def __init__(self, *, on_lost: Callable[[str], None]) -> None:
        self._on_lost = on_lost
        self._motions: dict[int, SimMotion] = {}
        self._last_number = 0
        self.lost_reason = ""

    def next_number(self) -> int:
        """Return a number that no motion has had.

        Raises:
            RobotError: the world is gone.
        """
        if self.lost_reason:
            raise RobotError(self.lost_reason, hint="connect the cell again")
        self._last_number += 1
        return self._last_number

    def add(self, motion: SimMotion) -> None:
        """Pass on to `motion` what happens to it."""
        self._motions[motion.number] = motion

    def under_way(self) -> tuple[SimMotion, ...]:
        """The motions that have not ended."""
        return tuple(self._motions.values())

    def happened(self, event: AnyMotionEvent) -> None:
        """Pass an event on to its motion."""
        motion = self._motions.get(event.motion)
        if motion is None:
            return
        motion.take(event)
        if motion.ended:
            del self._motions[event.motion]

    def lost(self, reason: str) -> None:
        """Fail all motions: the world is gone."""
        self.lost_reason = reason
        motions, self._motions = self._motions, {}
        for motion in motions.values():
            motion.finish(MotionReport(end=MotionEnd.FAILED, reason=reason))
        self._on_lost(reason)


def _answer(waiters: _Waiters) -> None:
    for waiter in waiters:
        if not waiter.done():
            waiter.set_result(None)
    waiters.clear()
