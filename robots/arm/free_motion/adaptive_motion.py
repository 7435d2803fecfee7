"""A motion that monitors its path: stops before an obstacle, then replans around it or resumes once it is gone."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Coroutine
from typing import TypeVar

from engine.errors import FlexcellError
from engine.skills.planning import Adaptation, MotionPhase
from robots.arm.execution.begun_motion import canceled_by_errors
from robots.arm.execution.collision_prediction import PredictedCollision
from robots.arm.execution.lookahead_path import PathReservation
from robots.arm.execution.monitored_motion import MonitoredMotion
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.free_motion.adaptive_motion_report import AdaptiveMotionListener, AdaptiveMotionReport
from robots.arm.free_motion.blocked_path_policy import BlockedPathPolicy
from robots.arm.free_motion.path_monitor import PathMonitor
from robots.arm.scene_queries.path_planner import PathPlanner, PathSegment
from robots.arm.scene_queries.planner_query import QuerySuperseded, await_answer, discard_query
from robots.planning.request import PlanRefusal
from robots.port import Motion, MotionEnd, MotionReport
from robots.workspace.workspace import Workspace

_HELD = "held"
# After so long at a creep an arm stops for another path; twice as long each time, as a creep gets there too.
_CREEP_S, _LONGEST_CREEP_S = 1.0, 16.0
T = TypeVar("T")

_log = logging.getLogger("flexcell.arm")


class AdaptiveMotion(MonitoredMotion):
    """Monitors consecutive motions of the port, each along a planned path.

    It also stops when separation monitoring has made the arm creep or stand for a while, and then prefers a path that
    keeps away from whoever is near. At rest it resumes the remaining path if that is free again, else follows a new
    path from there, else tries again after the next change. A hold persists through all of that; a cancel ends it.

    Args:
        segment: The first path, which starts at the set point; or the reason why there is none yet: the motion then
            starts by waiting.
        runner: The arm's motion runner.
        planner: Plans and checks paths.
        workspace: Notifies of scene changes.
        adaptation: Whether to monitor the path, and how long to wait.
        listener: Notified of phase and path changes.
    """

    def __init__(
        self,
        segment: PathSegment | str,
        *,
        runner: MotionRunner,
        planner: PathPlanner,
        workspace: Workspace,
        adaptation: Adaptation,
        listener: AdaptiveMotionListener,
    ) -> None:
        reservation = PathReservation(runner, workspace, made=adaptation.watch)
        super().__init__(arm=runner.name, reservation=reservation)
        self._runner = runner
        self._planner = planner
        self._paths = PathMonitor(runner, planner, workspace)
        self._waiting = BlockedPathPolicy(runner.clock, patience_s=adaptation.patience_s)
        self._adaptation = adaptation
        self._listener = listener
        self._clock = runner.clock
        self._phase_waiters: list[asyncio.Future[None]] = []
        self._checking = False
        self._cancelling: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._attempts, self._stops = 0, runner.stops
        self._creep_s = _CREEP_S
        self._detected_late = self._replan_failure = self._slowed = ""
        self.statistics = AdaptiveMotionReport()
        self.phase: MotionPhase = "moving"
        self.reason = ""
        self._segment: PathSegment | None = None
        self._obstacle = "" if isinstance(segment, PathSegment) else segment
        if isinstance(segment, PathSegment):
            self._follow(segment)
        else:
            self._halted, self.phase = True, "planning"
        self._start(workspace if adaptation.watch else None)

    @property
    def waited_s(self) -> float:
        """Total time waited for a free path."""
        return self._waiting.total_s

    async def resume(self) -> None:
        """Check whether the path is free; return when moving, or when the path is known to be blocked."""
        if not self._held:
            return
        self._held, self._checking = False, True
        self._changed.set()
        while not self._held and not self._task.done() and self._checking:
            waiter: asyncio.Future[None] = asyncio.get_running_loop().create_future()
            self._phase_waiters.append(waiter)
            await asyncio.wait((waiter, self._task), return_when=asyncio.FIRST_COMPLETED)

    def cancel(self) -> None:
        """Request deceleration on the path; `report` then returns CANCELED once at rest."""
        if not self._cancelled:
            self._cancelling.set_result(None)
        self._changed.set()
        super().cancel()

    def _note(self, names: frozenset[str]) -> None:
        self._paths.note(names)
        self._waiting.something_changed()

    async def _go(self) -> MotionReport:
        reason: str | None = self._obstacle or await self._pass()
        while reason is not None:
            report = await self._until_free(reason)
            if report is not None:
                return report
            reason = await self._pass()
        assert self._end is not None
        return self._end.result()

    async def _pass(self) -> str | None:
        """Follow the path; return None when the motion has ended, or why it was stopped."""
        inner, end, segment = self._inner, self._end, self._segment
        assert inner is not None
        assert end is not None
        assert segment is not None
        self._enter("moving", "")
        self._reservation.update(self._passed_s)
        while not end.done():
            await self._next_change(self._paths.look_s)
            if end.done() or self._cancelled:
                await asyncio.wait((end,))
                return None
            if self._halted:
                return _HELD
            if not self._adaptation.watch:
                continue
            try:
                collision = await self._answer(self._paths.ahead(segment, from_s=self._passed_s))
            except QuerySuperseded:
                continue
            if collision is not None and not end.done():
                await self._stop_before(inner, collision)
                return self.reason
            near = self._paths.near_reason
            slow = self._paths.slow_reason(for_s=_CREEP_S if near else self._creep_s)
            if slow and (self._waiting.may_search or near) and not end.done():
                self._slowed = slow
                self._creep_s = min(2.0 * self._creep_s, _LONGEST_CREEP_S)
                await self._stop(inner, slow)
                return slow
        return None

    async def _stop_before(self, inner: Motion, collision: PredictedCollision) -> None:
        """Come to rest before a predicted collision, and report if the arm stops too late."""
        await self._stop(inner, collision.reason)
        if self._passed_s >= collision.at_s:
            self._detected_late = "; it was detected too late to stop before it"
            self._enter("braking", collision.reason + self._detected_late)
            _log.warning("%s stopped too late: %s", self._runner.name, collision.reason)

    async def _stop(self, inner: Motion, reason: str) -> None:
        """Come to rest on the path."""
        if not self._halted:
            # If the arm was held meanwhile, that hold stopped it, not this.
            self.statistics.stops += 1
            self._halted = True
        self._enter("braking", reason)
        _log.info("%s stops: %s", self._runner.name, reason)
        await inner.hold()

    async def _until_free(self, reason: str) -> MotionReport | None:
        """Wait at rest until the arm moves again (None), or until the motion has ended."""
        stopped_here = reason != _HELD
        self._reservation.withdraw()
        if self._inner is not None:
            await self._inner.hold()
        self._waiting.rest()
        while True:
            if (over := await self._over()) is not None:
                return over
            if self._held:
                self._waiting.end()
                self._enter("waiting", _HELD)
                await self._next_change()
                continue
            self._changed.clear()
            try:
                why = await self._move_again(reused=stopped_here)
            except QuerySuperseded:
                continue
            if not why:
                self._waiting.end()
                return None
            if self._held or self._cancelled:
                continue
            if (over := await self._patience_over(why)) is not None:
                return over
            await self._next_change(self._waiting.next_look_s)
            # Changes in quick succession count as one: decisions always use the latest scene.

    async def _over(self) -> MotionReport | None:
        """Return the report of the motion if it was canceled, or ended by itself at rest; else None."""
        if self._cancelled:
            self._waiting.end()
            return await self._cancel_inner() or MotionReport(end=MotionEnd.CANCELED)
        if self._inner is None:
            reason = self._lost_reason or self._runner.port.reflex_reason
            return MotionReport(end=MotionEnd.FAILED, reason=reason) if reason else None
        if self._end is not None and self._end.done():
            self._waiting.end()
            return self._end.result()
        return None

    async def _patience_over(self, why: str) -> MotionReport | None:
        """Continue to wait for the reason `why`, or give up the motion when the patience is exhausted."""
        self._waiting.begin()
        self._enter("waiting", why)
        if not self._waiting.is_over:
            return None
        self._waiting.end()
        self.statistics.blocked = why
        await self._cancel_inner()
        patience_s = self._adaptation.patience_s
        waited = f" for {patience_s:g} s" if patience_s > 0.0 else ""
        return MotionReport(end=MotionEnd.FAILED, reason=f"no path is free{waited}: {why}")

    async def _move_again(self, *, reused: bool) -> str:
        """Move again, along the current path or a new one; return why that is impossible, empty on success."""
        monitor, waiting = self._paths, self._waiting
        try:
            if not self._adaptation.watch:
                return await self._resume(reused=False)
            if monitor.unobserved_reason:
                return monitor.unobserved_reason
            if near := monitor.near_reason:
                return near
            if self.reason and not waiting.has_rested(stops=self.statistics.stops):
                return self.reason
            # Two processes work in parallel: one checks the path while the other searches in case it is needed.
            search = self._begin_search() if waiting.may_search and self.phase != "waiting" else None
            try:
                if beside := await self._answer(monitor.beside()):
                    return beside
                blocked = "no path found yet"
                if self._inner is not None and self._segment is not None:
                    blocked = await self._answer(monitor.rest_of(self._segment, from_s=self._passed_s))
                if waiting.may_search and (why := blocked or self._slowed):
                    started_s = self._clock.now_s()
                    self._replan_failure = await self._follow_new_path(why, search or self._begin_search())
                    if not self._replan_failure:
                        return ""
                    waiting.searched(took_s=self._clock.now_s() - started_s)
                if not blocked:
                    return await self._resume(reused=reused)
                return blocked + self._detected_late + self._replan_failure
            finally:
                await discard_query(search)
        except FlexcellError as error:
            waiting.searched(took_s=0.0)
            return error.message

    def _begin_search(self) -> asyncio.Future[PathSegment | PlanRefusal]:
        self._attempts += 1
        start = self._runner.port.sample().desired_rad
        apart_m = self._paths.apart_m if self._slowed else 0.0
        return asyncio.ensure_future(self._planner.find(start, attempt=self._attempts - 1, apart_m=apart_m))

    async def _follow_new_path(self, blocked: str, search: asyncio.Future[PathSegment | PlanRefusal]) -> str:
        """Follow a new path from here once it is planned; return the reason of a failure, empty on success."""
        if self.phase != "waiting":
            self._enter("planning", blocked + self._detected_late)
        segment = await self._answer(search)
        if isinstance(segment, PlanRefusal):
            return f"; {segment.message}"
        # Only this check covers changes since the search started.
        collision = await self._answer(self._paths.along(segment))
        if collision is not None:
            return f"; on the new path {collision.reason}"
        if self._held or self._cancelled:
            return f"; {_HELD}"
        report = await self._cancel_inner()
        if report is not None and report.end is MotionEnd.FAILED:
            return f"; {report.reason}"
        self._inner = self._end = None
        if self._held or self._cancelled:
            return f"; {_HELD}"
        if self._lost_reason:
            return f"; {self._lost_reason}"
        if self._segment is not None:
            self.statistics.replans += 1
            _log.info("%s follows a new path", self._runner.name)
        self._follow(segment)
        return ""

    async def _resume(self, *, reused: bool) -> str:
        inner = self._inner
        if self._held or self._cancelled or inner is None:
            return _HELD
        self._halted = False
        self._detected_late = self._replan_failure = self._slowed = ""
        self._paths.begin()
        await inner.resume()
        if reused:
            self.statistics.reused += 1
            _log.info("%s resumes along its path", self._runner.name)
        return ""

    async def _answer(self, question: Coroutine[object, object, T] | asyncio.Future[T]) -> T:
        """Wait for the planner; raises QuerySuperseded once the motion is canceled, or has ended by itself."""
        ends = () if self._end is None else (self._end,)
        return await await_answer(question, unless=(self._cancelling, *ends))

    def _follow(self, segment: PathSegment) -> None:
        """Start to follow a path; raises RobotError if the arm rejects it."""
        runner = self._runner
        motion = runner.port.follow(segment.trajectory, tolerance=runner.tolerance)
        with canceled_by_errors(motion):
            self._monitor(motion, segment.trajectory)
            self._segment = segment
            self._detected_late = self._replan_failure = self._slowed = ""
            self._paths.begin()
            self._listener.follows(segment)

    @property
    def _lost_reason(self) -> str:
        """Why the arm is lost, or that it was: an arm that is found again does not begin to move by itself."""
        runner = self._runner
        if runner.stops == self._stops:
            return ""
        return runner.lost_reason or "the arm was stopped or lost meanwhile"

    @property
    def _cancelled(self) -> bool:
        return self._cancelling.done()

    def _enter(self, phase: MotionPhase, reason: str) -> None:
        if (phase, reason) != (self.phase, self.reason):
            if phase == "waiting" and reason != self.reason:
                _log.info("%s waits: %s", self._runner.name, reason)
            self.phase, self.reason = phase, reason
            self._listener.entered(phase, reason)
        if phase in ("moving", "waiting"):
            self._checking = False
        waiters, self._phase_waiters = self._phase_waiters, []
        for waiter in waiters:
            if not waiter.done():
                waiter.set_result(None)
