"""A motion that looks ahead: it stops before what comes into its way, and goes on around it or when it has gone."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Coroutine
from typing import TypeVar

from engine.errors import FlexcellError
from engine.skills.planning import Adaptation, MotionPhase
from robots.arm.adaptive_motion_report import AdaptiveMotionListener, AdaptiveMotionReport
from robots.arm.blocked_path_policy import BlockedPathPolicy
from robots.arm.lookahead_path import PathReservation
from robots.arm.motion_runner import MotionRunner
from robots.arm.path_monitor import PathMonitor, PredictedCollision
from robots.arm.path_planner import PathPlanner, PathSegment
from robots.arm.planner_query import QuerySuperseded, await_answer, discard_query
from robots.planning.request import PlanRefusal
from robots.port import Motion, MotionEnd, MotionReport
from robots.workspace.workspace import Workspace

_HELD = "held"
T = TypeVar("T")

_log = logging.getLogger("flexcell.arm")


class AdaptiveMotion:
    """Implements `robots.port.Motion` by motions of the port, one after the other, each along a confirmed way.

    While it moves, every change of the scene has the rest of the way looked at. Where that is blocked it
    decelerates on the way, and at rest it takes the first of: the rest of the way, free again; another way
    from there; the same again after the next change. A hold outlasts all of that, a cancel ends it.

    Args:
        leg: The first way, which starts at the set point; or why there is none yet, and the motion begins by waiting.
        runner: Of the arm.
        finder: Finds and checks ways.
        workspace: Tells of changes.
        adaptation: Whether to look ahead, and for how long to wait.
        shown: Who is told.
    """

    def __init__(
        self,
        leg: PathSegment | str,
        *,
        runner: MotionRunner,
        finder: PathPlanner,
        workspace: Workspace,
        adaptation: Adaptation,
        shown: AdaptiveMotionListener,
    ) -> None:
        self._runner = runner
        self._finder = finder
        self._workspace = workspace
        self._lookout = PathMonitor(runner, finder, workspace)
        self._claim = PathReservation(runner, workspace, made=adaptation.watch)
        self._waiting = BlockedPathPolicy(runner.clock, patience_s=adaptation.patience_s)
        self._adaptation = adaptation
        self._shown = shown
        self._clock = runner.clock
        self._woken = asyncio.Event()
        self._phase_waiters: list[asyncio.Future[None]] = []
        self._held = self._halted = self._looking = False
        self._cancelling: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._attempts = 0
        self._too_near = self._in_vain = ""
        self.tally = AdaptiveMotionReport()
        self.phase: MotionPhase = "moving"
        self.reason = ""
        self._leg: PathSegment | None = None
        self._inner: Motion | None = None
        self._end: asyncio.Future[MotionReport] | None = None
        if isinstance(leg, PathSegment):
            self._follow(leg)
        else:
            self._halted, self.phase = True, "planning"
        self._unwatch = workspace.watch(self._notice) if adaptation.watch else _nothing
        self._task = asyncio.create_task(
            self._run("" if isinstance(leg, PathSegment) else leg), name=f"adapting motion of {runner.name}"
        )

    @property
    def progress(self) -> float:
        """Share of the present way's time passed, 0 to 1."""
        return self._inner.progress if self._inner is not None else 0.0

    @property
    def waited_s(self) -> float:
        """How long it has waited for a way so far."""
        return self._waiting.total_s

    async def report(self) -> MotionReport:
        """Wait for the end."""
        return await asyncio.shield(self._task)

    async def hold(self) -> None:
        """Decelerate on the way and return when at rest; nothing moves the arm before `resume`."""
        self._held = self._halted = True
        self._woken.set()
        if self._inner is not None:
            await self._inner.hold()

    async def resume(self) -> None:
        """Look whether the way is free, and return when moving or when it is known that it is not."""
        if not self._held:
            return
        self._held, self._looking = False, True
        self._woken.set()
        while not self._held and not self._task.done() and self._looking:
            waiter: asyncio.Future[None] = asyncio.get_running_loop().create_future()
            self._phase_waiters.append(waiter)
            await asyncio.wait((waiter, self._task), return_when=asyncio.FIRST_COMPLETED)

    def cancel(self) -> None:
        """Ask to decelerate on the way; `report` then returns CANCELED once at rest."""
        if not self._cancelled:
            self._cancelling.set_result(None)
        self._woken.set()
        if self._inner is not None:
            self._inner.cancel()

    def _notice(self, names: frozenset[str]) -> None:
        """Hear of a change in the scene."""
        if self._runner.name in names and not self._halted:
            self._claim.update(self._passed_s)
        others = names - {self._runner.name}
        if others or not names:
            self._lookout.note(others)
            self._waiting.something_changed()
            self._woken.set()

    async def _run(self, obstacle: str) -> MotionReport:
        try:
            return await self._go(obstacle)
        except Exception as error:
            # Whatever is wrong here, the arm must not go on unwatched, and its goal must end with the reason.
            _log.exception("%s: the adapting motion failed", self._runner.name)
            await self._cancel_inner()
            return MotionReport(end=MotionEnd.FAILED, reason=f"{type(error).__name__}: {error}")
        finally:
            self._unwatch()
            self._claim.withdraw()
            if self._end is not None:
                self._end.cancel()

    async def _go(self, obstacle: str) -> MotionReport:
        reason: str | None = obstacle or await self._pass()
        while reason is not None:
            report = await self._until_free(reason)
            if report is not None:
                return report
            reason = await self._pass()
        assert self._end is not None
        return self._end.result()

    async def _pass(self) -> str | None:
        """Go along the way; return None when it has ended, or why it was stopped."""
        inner, end, leg = self._inner, self._end, self._leg
        assert inner is not None
        assert end is not None
        assert leg is not None
        self._enter("moving", "")
        self._claim.update(self._passed_s)
        while not end.done():
            await self._news(end)
            self._woken.clear()
            if end.done() or self._cancelled:
                await asyncio.wait((end,))
                return None
            if self._halted:
                return _HELD
            if not self._adaptation.watch:
                continue
            try:
                trouble = await self._answer(self._lookout.ahead(leg, from_s=self._passed_s))
            except QuerySuperseded:
                continue
            if trouble is not None and not end.done():
                await self._brake(inner, trouble)
                return self.reason
        return None

    async def _brake(self, inner: Motion, trouble: PredictedCollision) -> None:
        """Come to rest before a predicted collision, and say so where that is too near."""
        if not self._halted:
            # One who held the arm meanwhile stopped it, not this.
            self.tally.stops += 1
            self._halted = True
        self._enter("braking", trouble.reason)
        _log.info("%s stops: %s", self._runner.name, trouble.reason)
        await inner.hold()
        if self._passed_s >= trouble.at_s:
            self._too_near = "; it came too near to stop before it"
            self._enter("braking", trouble.reason + self._too_near)
            _log.warning("%s stopped too late: %s", self._runner.name, trouble.reason)

    async def _until_free(self, reason: str) -> MotionReport | None:
        """Wait at rest until the arm goes on (None), or until the motion is over."""
        stopped_here = reason != _HELD
        self._claim.withdraw()
        if self._inner is not None:
            await self._inner.hold()
        self._waiting.rest()
        while True:
            if (over := await self._over()) is not None:
                return over
            if self._held:
                self._waiting.end()
                self._enter("waiting", _HELD)
                await self._news(None)
                self._woken.clear()
                continue
            self._woken.clear()
            try:
                why = await self._go_on(reused=stopped_here)
            except QuerySuperseded:
                continue
            if not why:
                self._waiting.end()
                return None
            if self._held or self._cancelled:
                continue
            if (over := await self._patience_over(why)) is not None:
                return over
            await self._news(None, timeout_s=self._waiting.next_look_s)
            # Many changes in a row are one: what is decided from is always the newest scene.

    async def _over(self) -> MotionReport | None:
        """Return the end of the motion if it has been cancelled, or has ended by itself at rest."""
        if self._cancelled:
            self._waiting.end()
            return await self._cancel_inner() or MotionReport(end=MotionEnd.CANCELED)
        if self._inner is None:
            reflex = self._runner.port.reflex_reason
            return MotionReport(end=MotionEnd.FAILED, reason=reflex) if reflex else None
        if self._end is not None and self._end.done():
            self._waiting.end()
            return self._end.result()
        return None

    async def _cancel_inner(self) -> MotionReport | None:
        """Cancel the motion of the port and return how it ended; None where there is none."""
        inner, end = self._inner, self._end
        if inner is None or end is None:
            return None
        inner.cancel()
        await asyncio.wait((end,))
        return end.result()

    async def _patience_over(self, why: str) -> MotionReport | None:
        """Go on waiting for the reason `why`, or give the motion up."""
        self._waiting.begin()
        self._enter("waiting", why)
        if not self._waiting.is_over:
            return None
        self._waiting.end()
        self.tally.blocked = why
        await self._cancel_inner()
        patience_s = self._adaptation.patience_s
        waited = f" for {patience_s:g} s" if patience_s > 0.0 else ""
        return MotionReport(end=MotionEnd.FAILED, reason=f"no path is free{waited}: {why}")

    async def _go_on(self, *, reused: bool) -> str:
        """Move again, along the old way or another one; return why that is not possible, empty where it is."""
        lookout, waiting = self._lookout, self._waiting
        try:
            if not self._adaptation.watch:
                return await self._resume(reused=False)
            if lookout.unobserved_reason:
                return lookout.unobserved_reason
            if self.reason and not waiting.has_rested(stops=self.tally.stops):
                return self.reason
            # Two processes work at once: while one looks, the other one searches in case that is needed.
            search = self._begin_search() if waiting.may_search and self.phase != "waiting" else None
            try:
                if beside := await self._answer(lookout.beside()):
                    return beside
                blocked = "no path found yet"
                if self._inner is not None and self._leg is not None:
                    blocked = await self._answer(lookout.rest_of(self._leg, from_s=self._passed_s))
                if not blocked:
                    return await self._resume(reused=reused)
                if waiting.may_search:
                    began_s = self._clock.now_s()
                    self._in_vain = await self._go_around(blocked, search or self._begin_search())
                    if not self._in_vain:
                        return ""
                    waiting.searched(took_s=self._clock.now_s() - began_s)
                return blocked + self._too_near + self._in_vain
            finally:
                await discard_query(search)
        except FlexcellError as error:
            waiting.searched(took_s=0.0)
            return error.message

    def _begin_search(self) -> asyncio.Future[PathSegment | PlanRefusal]:
        self._attempts += 1
        start = self._runner.port.sample().desired_rad
        return asyncio.ensure_future(self._finder.find(start, attempt=self._attempts - 1))

    async def _go_around(self, blocked: str, search: asyncio.Future[PathSegment | PlanRefusal]) -> str:
        """Go another way from here when it is found; return what came of that where it came to nothing."""
        if self.phase != "waiting":
            self._enter("planning", blocked + self._too_near)
        found = await self._answer(search)
        if isinstance(found, PlanRefusal):
            return f"; {found.message}"
        # What has changed since the search began is seen by this look only.
        trouble = await self._answer(self._lookout.along(found))
        if trouble is not None:
            return f"; on another way {trouble.reason}"
        if self._held or self._cancelled:
            return f"; {_HELD}"
        report = await self._cancel_inner()
        if report is not None and report.end is MotionEnd.FAILED:
            return f"; {report.reason}"
        self._inner = self._end = None
        if self._held or self._cancelled:
            return f"; {_HELD}"
        if self._leg is not None:
            self.tally.replans += 1
            _log.info("%s goes another way", self._runner.name)
        self._follow(found)
        return ""

    async def _resume(self, *, reused: bool) -> str:
        inner = self._inner
        if self._held or self._cancelled or inner is None:
            return _HELD
        self._halted = False
        self._too_near = self._in_vain = ""
        await inner.resume()
        if reused:
            self.tally.reused += 1
            _log.info("%s goes on along its way", self._runner.name)
        return ""

    async def _answer(self, question: Coroutine[object, object, T] | asyncio.Future[T]) -> T:
        """Wait for an answer of the planner; raises Overtaken once the motion is cancelled, or has ended by itself."""
        ends = () if self._end is None else (self._end,)
        return await await_answer(question, unless=(self._cancelling, *ends))

    def _follow(self, leg: PathSegment) -> None:
        """Start along a way; raises RobotError where the arm does not take it."""
        runner = self._runner
        self._inner = inner = runner.port.follow(leg.trajectory, tolerance=runner.tolerance)
        self._end = asyncio.ensure_future(inner.report())
        self._leg, self._halted = leg, False
        self._too_near = self._in_vain = ""
        self._claim.renew(leg.trajectory)
        self._shown.follows(leg)

    @property
    def _cancelled(self) -> bool:
        return self._cancelling.done()

    @property
    def _passed_s(self) -> float:
        """How much of the present way's own time has passed."""
        return self.progress * self._leg.trajectory.duration_s if self._leg is not None else 0.0

    async def _news(self, end: asyncio.Future[MotionReport] | None, *, timeout_s: float | None = None) -> None:
        """Return at the next change, or when `end` is there."""
        woken = asyncio.ensure_future(self._woken.wait())
        try:
            waits = (woken,) if end is None else (woken, end)
            await asyncio.wait(waits, timeout=timeout_s, return_when=asyncio.FIRST_COMPLETED)
        finally:
            woken.cancel()

    def _enter(self, phase: MotionPhase, reason: str) -> None:
        if (phase, reason) != (self.phase, self.reason):
            if phase == "waiting" and reason != self.reason:
                _log.info("%s waits: %s", self._runner.name, reason)
            self.phase, self.reason = phase, reason
            self._shown.entered(phase, reason)
        if phase in ("moving", "waiting"):
            self._looking = False
        waiters, self._phase_waiters = self._phase_waiters, []
        for waiter in waiters:
            if not waiter.done():
                waiter.set_result(None)


def _nothing() -> None:
    """Do nothing."""
