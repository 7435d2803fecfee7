"""The active motions of a control process, by number: the side on which skills wait."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from engine.errors import CONNECT_AGAIN, RobotError
from robots.control.commanding.arm_commands import CancelMotion, HoldMotion, MotionCommand, ResumeMotion
from robots.control.motion_event import (
    AnyMotionEvent,
    MotionFinished,
    MotionHeld,
    MotionResumed,
    ReflexTripped,
    SetPointJumped,
)
from robots.port import MotionEnd, MotionReport


class CommandedMotion:
    """One motion that a control loop executes; implements `robots.port.Motion`."""

    def __init__(
        self, number: int, *, send: Callable[[MotionCommand], None], progress: Callable[[], float | None]
    ) -> None:
        self.number = number
        self._send = send
        self._measure = progress
        self._last_progress = 0.0
        self._loop = asyncio.get_running_loop()
        self._end: asyncio.Future[MotionReport] = self._loop.create_future()
        self._asked = 0
        self._waiters: list[tuple[int, asyncio.Future[None]]] = []

    @property
    def ended(self) -> bool:
        """True once it has a report."""
        return self._end.done()

    @property
    def progress(self) -> float:
        """Elapsed share of the trajectory's time, 0 to 1; frozen at the end."""
        if not self._end.done():
            measured = self._measure()
            if measured is not None:
                self._last_progress = measured
        return self._last_progress

    async def report(self) -> MotionReport:
        """Wait for the end; cancelling one waiter affects neither the motion nor other waiters."""
        return await asyncio.shield(self._end)

    async def hold(self) -> None:
        """Decelerate on the path and return when at rest, or when the motion has ended or been resumed meanwhile."""
        self._asked += 1
        await self._ask(HoldMotion(motion=self.number, request=self._asked))

    async def resume(self) -> None:
        """Resume along the path and return when moving, or when the motion has ended or been held meanwhile."""
        self._asked += 1
        await self._ask(ResumeMotion(motion=self.number, request=self._asked))

    def cancel(self) -> None:
        """Request deceleration on the path; `report` then returns CANCELED once at rest."""
        if not self._end.done():
            self._send(CancelMotion(motion=self.number))

    async def _ask(self, command: HoldMotion | ResumeMotion) -> None:
        if self._end.done():
            return
        self._send(command)
        answer: asyncio.Future[None] = self._loop.create_future()
        self._waiters.append((command.request, answer))
        await answer

    def take(self, event: AnyMotionEvent) -> None:
        """Apply an event of the control loop."""
        match event:
            case MotionHeld() | MotionResumed():
                # Of a hold and a resume in quick succession only the last is reported; it answers both. Later
                # requests are not answered by it: they are still in transit to the control loop.
                self._answer(event.request)
            case ReflexTripped() | SetPointJumped():
                # If it ends the motion, its end follows, with the reason.
                pass
            case MotionFinished():
                self._last_progress = event.progress
                self.end_with(event.report)

    def end_with(self, report: MotionReport) -> None:
        """End the motion; a second end is ignored."""
        if not self._end.done():
            self._end.set_result(report)
        self._answer(self._asked)

    def _answer(self, up_to: int) -> None:
        for request, waiter in self._waiters:
            if request <= up_to and not waiter.done():
                waiter.set_result(None)
        self._waiters = [entry for entry in self._waiters if not entry[1].done()]


class MotionRegistry:
    """Numbers motions and forwards the events of the control process to them.

    Args:
        on_lost: Called with the reason when the control process is lost.
        at_rest_when_lost: Whether its devices are at rest then, as simulated ones are.
    """

    def __init__(self, *, on_lost: Callable[[str], None], at_rest_when_lost: bool = True) -> None:
        self._at_rest_when_lost = at_rest_when_lost
        self._on_lost = on_lost
        self._motions: dict[int, CommandedMotion] = {}
        self._last_number = 0
        self.lost_reason = ""
        self.closed_reason = ""
        """Why no motion may start at present; empty if motions may start."""
        self.closed_hint = "wait a moment"
        self.reflexes: dict[str, str] = {}
        """Latest reflex reason of each arm."""
        self._reflex_listeners: dict[str, list[Callable[[str], None]]] = {}

    def next_number(self) -> int:
        """Return an unused motion number.

        Raises:
            RobotError: the control process is lost, or no motion may start at present.
        """
        if self.lost_reason:
            raise RobotError(self.lost_reason, hint=CONNECT_AGAIN)
        if self.closed_reason:
            raise RobotError(self.closed_reason, hint=self.closed_hint)
        self._last_number += 1
        return self._last_number

    def add(self, motion: CommandedMotion) -> None:
        """Forward events to `motion`."""
        self._motions[motion.number] = motion

    def active(self) -> tuple[CommandedMotion, ...]:
        """Return the motions that have not ended."""
        return tuple(self._motions.values())

    def when_reflex(self, arm: str, callback: Callable[[str], None]) -> None:
        """Call `callback` with the reason at every reflex stop of an arm."""
        self._reflex_listeners.setdefault(arm, []).append(callback)

    def happened(self, event: AnyMotionEvent) -> None:
        """Forward an event to its motion; report a reflex also without an active motion."""
        if isinstance(event, ReflexTripped):
            self.reflexes[event.arm] = event.reason
            for callback in self._reflex_listeners.get(event.arm, ()):
                callback(event.reason)
        motion = self._motions.get(event.motion)
        if motion is None:
            return
        motion.take(event)
        if motion.ended:
            del self._motions[event.motion]

    def found(self) -> None:
        """Accept motions again: the control process is restored."""
        self.lost_reason = ""

    def lost(self, reason: str) -> None:
        """Fail all motions; no motion may start until `found`."""
        self.lost_reason = reason
        motions, self._motions = self._motions, {}
        for motion in motions.values():
            motion.end_with(MotionReport(end=MotionEnd.FAILED, reason=reason, at_rest=self._at_rest_when_lost))
        self._on_lost(reason)
