"""A motion along a given path that is monitored: it stops before a contact, and waits or fails at rest."""

from __future__ import annotations

import asyncio
import logging
from dataclasses import replace

import numpy as np

from engine.clock import Clock
from engine.skills.collision_options import CollisionOptions
from robots.arm.execution.collision_prediction import PredictedCollision, predict_collision
from robots.arm.execution.lookahead_path import PathReservation
from robots.arm.execution.monitored_motion import MonitoredMotion
from robots.arm.scene_queries.path_guard import PathGuard, PathRules
from robots.arm.scene_queries.planner_query import QuerySuperseded, await_answer
from robots.port import Array, JointTrajectory, Motion, MotionReport

# So long an arm that is not monitored waits at rest for the next check.
_UNMONITORED_S = 5.0
# Time from a change of the scene until the arm brakes, and the share of the acceleration limits with which it does.
_REACTION_S, _BRAKING_SHARE = 0.2, 0.4
# At rest the path is checked at least this often.
_LOOK_S = 0.25
_SHORTEST_S = 0.001

_log = logging.getLogger("flexcell.arm")


class GivenPathMotion(MonitoredMotion):
    """Monitors a motion of the port along a trajectory for which there is no other path.

    Before another arm, which may leave, it first goes as far as it can stop. At rest it continues when the path is
    free within the patience of the goal, else the motion fails with the reason. Of two arms whose paths meet, the one
    that starts later stops.

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
        super().__init__(arm=guard.arm, reservation=reservation)
        self._motion, self._path = inner, trajectory
        self._ended = self._monitor(inner, trajectory)
        self._rules = rules
        self._guard = guard
        self._patience_s = options.patience_s
        self._clock = clock
        speeds = np.abs(trajectory.velocity_rad_s)
        self._stopping_s = _REACTION_S + float((speeds / (_BRAKING_SHARE * acceleration_rad_s2)).max(initial=0.0))
        self._checked = asyncio.Event()
        reservation.update(0.0)
        self._start(guard.workspace)

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

    async def _go(self) -> MotionReport:
        try:
            return await self._pass()
        except QuerySuperseded:
            return await self._ended
        finally:
            self._checked.set()

    def _note(self, names: frozenset[str]) -> None:
        """Any change is checked."""

    async def _pass(self) -> MotionReport:
        timeout_s: float | None = None
        waits_since_s: float | None = None
        while True:
            await self._next_change(timeout_s)
            timeout_s = None
            if self._ended.done():
                return self._ended.result()
            if self._held:
                waits_since_s = None
                continue
            found = await await_answer(self._predict(), unless=(self._ended,))
            if self._held or self._ended.done():
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
            patience_s = max(self._patience_s, _UNMONITORED_S) if found.is_unmonitored else self._patience_s
            if now_s - waits_since_s >= patience_s:
                return await self._fail(found.reason)
            # Never so short that the clock stands still.
            timeout_s = max(_SHORTEST_S, min(_LOOK_S, waits_since_s + patience_s - now_s))

    async def _predict(self) -> PredictedCollision | None:
        """Return what is on the remaining path; None if it is free."""
        guard = self._guard
        query = guard.check(self._path, self._rules, from_s=self._passed_s)
        return await predict_collision(guard.workspace, query)

    def _time_to_brake_s(self, found: PredictedCollision) -> float:
        """Return how long the arm may go on; 0 if it must brake now."""
        if not self._guard.is_other_arm(found.pairs):
            return 0.0
        return max(0.0, found.at_s - self._passed_s - self._stopping_s)

    async def _stop_before(self, found: PredictedCollision) -> PredictedCollision:
        """Come to rest; return the reason, with a remark if the arm has stopped too late."""
        self._halted = True
        _log.info("%s stops: %s", self._guard.arm, found.reason)
        await self._motion.hold()
        self._reservation.withdraw()
        if self._passed_s < found.at_s:
            return found
        return replace(found, reason=f"{found.reason}; it was detected too late to stop before it")

    async def _go_on(self) -> None:
        if self._halted:
            self._halted = False
            self._reservation.update(self._passed_s)
            await self._motion.resume()
        self._checked.set()
