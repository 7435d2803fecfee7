"""A motion along a given path that is monitored: it stops before a contact, and waits or fails at rest."""

from __future__ import annotations

import asyncio
import logging
import math
from dataclasses import dataclass

import numpy as np

from engine.clock import Clock
from engine.errors import FlexcellError
from engine.skills.collision_options import CollisionOptions
from robots.arm.execution.lookahead_path import PathReservation
from robots.arm.scene_queries.path_guard import PathGuard, PathRules
from robots.arm.scene_queries.path_planner import describe_contacts
from robots.arm.scene_queries.planner_query import QuerySuperseded, await_answer
from robots.port import Array, JointTrajectory, Motion, MotionEnd, MotionReport

# Timeout of a check: a longer one counts as no monitoring. So long the arm then waits at rest for the next.
_CHECK_S, _UNMONITORED_S = 0.3, 5.0
# Time from a change of the scene until the arm brakes, and the share of the acceleration limits with which it does.
_REACTION_S, _BRAKING_SHARE = 0.2, 0.4
# At rest the path is checked at least this often.
_LOOK_S = 0.25

_log = logging.getLogger("flexcell.arm")


@dataclass(frozen=True, kw_only=True)
class _Obstruction:
    """Why the arm must stop; `at_s` in the path's own time, and `may_leave` if it is another arm."""

    reason: str
    at_s: float = math.inf
    may_leave: bool = False
    unmonitored: bool = False


class MonitoredMotion:
    """Implements `robots.port.Motion` around a motion of the port along a trajectory.

    Every change of the scene triggers a check of the remaining path. Before a contact the arm decelerates on its
    path; only for another arm, which may leave, it first goes as far as it can stop. At rest it continues when the
    path is free within the patience of the goal, else the motion fails with the reason. While it moves, its path is
    reserved: of two arms whose paths meet, the one that starts later stops.

    Args:
        inner: The motion of the port.
        trajectory: Its path; what the port adds to it, as a force controller does, is not known.
        rules: The contacts that it may make.
        guard: Checks the path.
        options: The collision options of the goal.
        reservation: Keeps other arms off the remaining path.
        clock: The arm's clock.
        acceleration_rad_s2: The acceleration limits, (n,).
    """

    def __init__(
        self,
        inner: Motion,
        trajectory: JointTrajectory,
        rules: PathRules,
        *,
        guard: PathGuard,
        options: CollisionOptions,
        reservation: PathReservation,
        clock: Clock,
        acceleration_rad_s2: Array,
    ) -> None:
        self._inner = inner
        self._trajectory = trajectory
        self._rules = rules
        self._guard = guard
        self._patience_s = options.patience_s
        self._reservation = reservation
        self._clock = clock
        speeds = np.abs(trajectory.velocity_rad_s)
        self._stopping_s = _REACTION_S + float((speeds / (_BRAKING_SHARE * acceleration_rad_s2)).max(initial=0.0))
        self._changed = asyncio.Event()
        self._checked = asyncio.Event()
        self._held = self._halted = False
        self._end = asyncio.ensure_future(inner.report())
        self._unwatch = guard.workspace.watch(self._notice)
        reservation.renew(trajectory)
        reservation.update(0.0)
        if guard.workspace.shared:
            # Another arm may have reserved its path since this one was checked.
            self._changed.set()
        self._task = asyncio.create_task(self._run(), name=f"path monitoring of {guard.arm}")

    @property
    def progress(self) -> float:
        """Elapsed share of the trajectory's time, 0 to 1."""
        return self._inner.progress

    async def report(self) -> MotionReport:
        """Wait for the end."""
        return await asyncio.shield(self._task)

    async def hold(self) -> None:
        """Decelerate on the path and return when at rest; nothing moves the arm before `resume`."""
        self._held = self._halted = True
        self._changed.set()
        await self._inner.hold()
        if self._halted:
            self._reservation.withdraw()

    async def resume(self) -> None:
        """Check whether the path is free; return when moving, or when the path is known to be blocked."""
        if not self._held:
            return
        self._held = False
        self._checked.clear()
        self._changed.set()
        checked = asyncio.ensure_future(self._checked.wait())
        try:
            await asyncio.wait((checked, self._task), return_when=asyncio.FIRST_COMPLETED)
        finally:
            checked.cancel()

    def cancel(self) -> None:
        """Request deceleration on the path; `report` then returns CANCELED once at rest."""
        self._inner.cancel()

    def _notice(self, names: frozenset[str]) -> None:
        if self._guard.arm in names and not self._halted:
            self._reservation.update(self._passed_s)
        if names - {self._guard.arm} or not names:
            self._changed.set()

    async def _run(self) -> MotionReport:
        try:
            return await self._monitor()
        except QuerySuperseded:
            return await self._end
        except Exception as error:
            # Whatever fails here, the arm must not continue unmonitored, and its goal must end with the reason.
            _log.exception("%s: path monitoring failed", self._guard.arm)
            return await self._fail(f"path monitoring failed: {type(error).__name__}: {error}")
        finally:
            self._unwatch()
            self._reservation.withdraw()
            self._checked.set()

    async def _monitor(self) -> MotionReport:
        timeout_s: float | None = None
        waits_since_s: float | None = None
        while True:
            await self._next_change(timeout_s)
            timeout_s = None
            if self._end.done():
                return self._end.result()
            if self._held:
                waits_since_s = None
                continue
            found = await await_answer(self._obstruction(), unless=(self._end,))
            if self._held or self._end.done():
                continue
            if found is None:
                waits_since_s = None
                await self._go_on()
                continue
            if not self._halted:
                timeout_s = self._time_to_brake_s(found)
                if timeout_s > 0.0:
                    continue
                found = await self._stop_before(found)
            self._checked.set()
            now_s = self._clock.now_s()
            waits_since_s = now_s if waits_since_s is None else waits_since_s
            patience_s = max(self._patience_s, _UNMONITORED_S) if found.unmonitored else self._patience_s
            if now_s - waits_since_s >= patience_s:
                return await self._fail(found.reason)
            timeout_s = min(_LOOK_S, waits_since_s + patience_s - now_s)

    async def _next_change(self, timeout_s: float | None) -> None:
        """Return at the next change of the scene, at the end of the motion, or after `timeout_s`."""
        changed = asyncio.ensure_future(self._changed.wait())
        try:
            await asyncio.wait((changed, self._end), timeout=timeout_s, return_when=asyncio.FIRST_COMPLETED)
        finally:
            changed.cancel()
        self._changed.clear()

    async def _obstruction(self) -> _Obstruction | None:
        """Return what is on the remaining path; None if it is free."""
        guard, workspace = self._guard, self._guard.workspace
        if workspace.unobserved_reason:
            return _Obstruction(reason=workspace.unobserved_reason, unmonitored=True)
        try:
            async with asyncio.timeout(_CHECK_S):
                check = await guard.check(self._trajectory, self._rules, from_s=self._passed_s)
        except TimeoutError:
            return _Obstruction(reason=f"the path was not checked within {_CHECK_S:g} s", unmonitored=True)
        except FlexcellError as error:
            return _Obstruction(reason=f"path monitoring is not available: {error.message}", unmonitored=True)
        if check.blocked_at_s is None:
            return None
        return _Obstruction(
            reason=describe_contacts(check.pairs), at_s=check.blocked_at_s, may_leave=guard.is_other_arm(check.pairs)
        )

    def _time_to_brake_s(self, found: _Obstruction) -> float:
        """Return how long the arm may go on; 0 if it must brake now."""
        if not found.may_leave:
            return 0.0
        return max(0.0, found.at_s - self._passed_s - self._stopping_s)

    async def _stop_before(self, found: _Obstruction) -> _Obstruction:
        """Come to rest; return the reason, with a remark if the arm has stopped too late."""
        self._halted = True
        _log.info("%s stops: %s", self._guard.arm, found.reason)
        await self._inner.hold()
        self._reservation.withdraw()
        if self._passed_s < found.at_s:
            return found
        return _Obstruction(reason=f"{found.reason}; it was detected too late to stop before it", at_s=found.at_s)

    async def _go_on(self) -> None:
        if self._halted:
            self._halted = False
            self._reservation.update(self._passed_s)
            await self._inner.resume()
        self._checked.set()

    async def _fail(self, reason: str) -> MotionReport:
        self._inner.cancel()
        await asyncio.wait((self._end,))
        report = self._end.result()
        if report.end is MotionEnd.FAILED or not report.at_rest:
            return report
        return MotionReport(end=MotionEnd.FAILED, reason=reason, contact=report.contact, data=report.data)

    @property
    def _passed_s(self) -> float:
        """Elapsed time of the path, in seconds of its own time."""
        return self._inner.progress * self._trajectory.duration_s
