"""What all motions have in common that look where they go: a motion of the port, watched, held and reserved."""

from __future__ import annotations

import asyncio
import logging
from abc import ABC, abstractmethod
from collections.abc import Callable

from robots.arm.execution.lookahead_path import PathReservation
from robots.port import JointTrajectory, Motion, MotionEnd, MotionReport
from robots.workspace.workspace import Workspace

_log = logging.getLogger("flexcell.arm")


class MonitoredMotion(ABC):
    """Implements `robots.port.Motion` around motions of the port along trajectories.

    While it moves, every change of the scene triggers a check of the remaining path, which is reserved. Before a
    contact the arm decelerates on its path. What it does at rest is the mode of the motion: see `_go`.

    Args:
        arm: Name of the arm.
        reservation: Keeps other arms off the remaining path.
    """

    _task: asyncio.Task[MotionReport]

    def __init__(self, *, arm: str, reservation: PathReservation) -> None:
        self._arm = arm
        self._reservation = reservation
        self._held = self._halted = False
        self._inner: Motion | None = None
        self._trajectory: JointTrajectory | None = None
        self._end: asyncio.Future[MotionReport] | None = None
        self._changed = asyncio.Event()
        # What has changed since the path was checked, the scene or a reservation, has notified nobody.
        self._changed.set()
        self._unwatch: Callable[[], None] = _no_operation

    @property
    def progress(self) -> float:
        """Elapsed share of the current path's duration, 0 to 1."""
        return self._inner.progress if self._inner is not None else 0.0

    async def report(self) -> MotionReport:
        """Wait for the end."""
        return await asyncio.shield(self._task)

    async def hold(self) -> None:
        """Decelerate on the path and return when at rest; nothing moves the arm before `resume`."""
        self._held = self._halted = True
        self._changed.set()
        if self._inner is not None:
            await self._inner.hold()
        if self._halted:
            self._reservation.withdraw()

    @abstractmethod
    async def resume(self) -> None:
        """Check whether the path is free; return when moving, or when the path is known to be blocked."""

    def cancel(self) -> None:
        """Request deceleration on the path; `report` then returns CANCELED once at rest."""
        if self._inner is not None:
            self._inner.cancel()

    def _start(self, watched: Workspace | None) -> None:
        """Begin, notified of the changes of a workspace; call it last, when nothing can fail any more."""
        if watched is not None:
            self._unwatch = watched.watch(self._notice)
        self._task = asyncio.create_task(self._run(), name=f"path monitoring of {self._arm}")

    @abstractmethod
    async def _go(self) -> MotionReport:
        """Follow the path, stop before contacts, and decide at rest what is next; return the end."""

    @abstractmethod
    def _note(self, names: frozenset[str]) -> None:
        """Record what has changed beside the arm."""

    def _monitor(self, motion: Motion, trajectory: JointTrajectory) -> asyncio.Future[MotionReport]:
        """Monitor a motion of the port from now on; return its end."""
        self._inner, self._trajectory = motion, trajectory
        self._end = asyncio.ensure_future(motion.report())
        self._halted = False
        self._reservation.renew(trajectory)
        return self._end

    def _notice(self, names: frozenset[str]) -> None:
        """Handle a change of the scene."""
        others = names - {self._arm}
        if others or not names:
            self._changed.set()
            self._note(others)
        if self._arm in names and not self._halted:
            self._reservation.update(self._passed_s)

    async def _run(self) -> MotionReport:
        try:
            return await self._go()
        except Exception as error:
            # Whatever fails here, the arm must not continue unmonitored, and its goal must end with the reason.
            _log.exception("%s: path monitoring failed", self._arm)
            return await self._fail(f"path monitoring failed: {type(error).__name__}: {error}")
        finally:
            self._unwatch()
            self._reservation.withdraw()

    async def _next_change(self, timeout_s: float | None = None) -> None:
        """Return at the next change, at the end of the motion, or after `timeout_s`."""
        changed = asyncio.ensure_future(self._changed.wait())
        try:
            waits = (changed,) if self._end is None else (changed, self._end)
            await asyncio.wait(waits, timeout=timeout_s, return_when=asyncio.FIRST_COMPLETED)
        finally:
            changed.cancel()
        self._changed.clear()

    async def _cancel_inner(self) -> MotionReport | None:
        """Cancel the motion of the port and return its report; None without a motion."""
        inner, end = self._inner, self._end
        if inner is None or end is None:
            return None
        inner.cancel()
        await asyncio.wait((end,))
        return end.result()

    async def _fail(self, reason: str) -> MotionReport:
        """Come to rest; return a failure with the reason, or that of the motion itself."""
        report = await self._cancel_inner() or MotionReport(end=MotionEnd.CANCELED)
        if report.end is MotionEnd.FAILED or not report.at_rest:
            return report
        return MotionReport(end=MotionEnd.FAILED, reason=reason, contact=report.contact, data=report.data)

    @property
    def _passed_s(self) -> float:
        """Elapsed time of the current path, in seconds of its own time."""
        return self.progress * self._trajectory.duration_s if self._trajectory is not None else 0.0


def _no_operation() -> None:
    """Do nothing."""
