"""A stream that is monitored: the arm comes to rest before a contact on the path that it takes until then."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable

import numpy as np

from robots.arm.execution.collision_prediction import predict_collision
from robots.arm.scene_queries.path_guard import PathGuard, PathRules
from robots.port import JointTrajectory, MotionEnd, MotionReport, MotionStream

# Period of the checks.
_PERIOD_S = 0.03
# An arm whose path until rest is shorter stands still.
_MOVES_RAD = 5e-3
_log = logging.getLogger("flexcell.arm")


class MonitoredStream:
    """Implements `robots.port.MotionStream` around a stream of the port.

    Args:
        inner: The stream of the port.
        rules: The contacts that it may make.
        guard: Checks paths.
        ahead: Returns the path that the arm takes until it has come to rest.
        may_resume: Whether an arm that stands before a contact may follow the stream again; None: the stream fails.
    """

    def __init__(
        self,
        inner: MotionStream,
        rules: PathRules,
        *,
        guard: PathGuard,
        ahead: Callable[[], JointTrajectory],
        may_resume: Callable[[], bool] | None = None,
    ) -> None:
        self._inner = inner
        self._rules = rules
        self._guard = guard
        self._ahead = ahead
        self._may_resume = may_resume
        self._held = self._stands = False
        self.held_by = ""
        """Why the arm was brought to rest here; empty once it moves freely again."""
        self._end = asyncio.ensure_future(inner.report())
        guard.workspace.require()
        self._task = asyncio.create_task(self._run(), name=f"stream monitoring of {guard.arm}")

    @property
    def progress(self) -> float:
        """That of the stream."""
        return self._inner.progress

    async def report(self) -> MotionReport:
        """Wait for the end."""
        return await asyncio.shield(self._task)

    async def hold(self) -> None:
        """Decelerate and return when at rest; nothing moves the arm before `resume`."""
        self._held = True
        await self._inner.hold()

    async def resume(self) -> None:
        """Follow the stream again; an arm that stands before a contact does so once it may."""
        self._held = False
        if not self._stands:
            await self._inner.resume()

    def cancel(self) -> None:
        """Request deceleration; `report` then returns CANCELED once at rest."""
        self._inner.cancel()

    def send(self, values: tuple[float, ...], *, age_s: float = 0.0) -> None:
        """Send values; raises as the stream of the port does."""
        self._inner.send(values, age_s=age_s)

    def finish(self) -> None:
        """Request to come to rest and end as REACHED."""
        self._inner.finish()

    async def _run(self) -> MotionReport:
        try:
            return await self._monitor()
        except Exception as error:
            # Whatever fails here, the arm must not continue unmonitored.
            _log.exception("%s: stream monitoring failed", self._guard.arm)
            return await self._fail(f"stream monitoring failed: {type(error).__name__}: {error}")
        finally:
            self._guard.workspace.release()

    async def _monitor(self) -> MotionReport:
        while not self._end.done():
            reason = "" if self._held else await self._obstruction()
            if reason and not self._end.done():
                _log.info("%s stops: %s", self._guard.arm, reason)
                if self._may_resume is None:
                    return await self._fail(reason)
                await self._stand_before(reason, self._may_resume)
            await self._period()
        return self._end.result()

    async def _obstruction(self) -> str:
        """Return why the arm must come to rest now; empty if its path is free."""
        guard, rules = self._guard, self._rules
        path = self._ahead()
        query = guard.check(path, rules, from_s=0.0)
        found = await predict_collision(guard.workspace, query, by_cameras=not rules.person_at_arm)
        if found is not None:
            return found.reason
        if np.abs(path.position_rad[-1] - path.position_rad[0]).max() > _MOVES_RAD:
            self.held_by = ""
        return ""

    async def _stand_before(self, reason: str, may_resume: Callable[[], bool]) -> None:
        """Come to rest, and follow the stream again once it leads away."""
        self.held_by, self._stands = reason, True
        await self._inner.hold()
        while not self._end.done() and (self._held or not may_resume()):
            await self._period()
        self._stands = False
        await self._inner.resume()

    async def _period(self) -> None:
        await asyncio.wait((self._end,), timeout=_PERIOD_S)

    async def _fail(self, reason: str) -> MotionReport:
        self._inner.cancel()
        await asyncio.wait((self._end,))
        report = self._end.result()
        if report.end is MotionEnd.FAILED or not report.at_rest:
            return report
        return MotionReport(end=MotionEnd.FAILED, reason=reason, data=report.data)
