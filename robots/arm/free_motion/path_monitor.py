"""Monitors the scene for one moving arm: whether its path is free, and what moves near it while it is at rest."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Coroutine
from dataclasses import dataclass

from engine.errors import FlexcellError
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.scene_queries.path_planner import PathPlanner, PathSegment, describe_contacts
from robots.planning.request import PathCheck
from robots.workspace.path_reservations import describe_names
from robots.workspace.workspace import Workspace

# Timeout of a check: a longer one counts as no monitoring.
_CHECK_S = 0.3
# An object that changed within this time counts as moving; within this distance it keeps a resting arm at rest.
_RECENT_S, _APART_M = 0.5, 0.08


@dataclass(frozen=True, kw_only=True)
class PredictedCollision:
    """Why an arm must stop, and the time of the collision in its path's own time; infinite if unknown."""

    reason: str
    at_s: float = math.inf


class PathMonitor:
    """Checks the paths of one arm for one goal."""

    def __init__(self, runner: MotionRunner, planner: PathPlanner, workspace: Workspace) -> None:
        self._runner = runner
        self._planner = planner
        self._workspace = workspace
        self._changed_s: dict[str, float] = {}

    def note(self, names: frozenset[str]) -> None:
        """Record the names of objects that have just changed."""
        now_s = self._runner.clock.now_s()
        self._changed_s.update((name, now_s) for name in names)

    @property
    def unobserved_reason(self) -> str:
        """Why the scene is not observed; empty if it is."""
        return self._workspace.unobserved_reason

    async def ahead(self, segment: PathSegment, *, from_s: float) -> PredictedCollision | None:
        """Return the collision on the remaining path that the arm follows; None if it is free."""
        return await self._predict(self._planner.check(segment, from_s=from_s, margin_m=self._planner.margin_m))

    async def along(self, segment: PathSegment) -> PredictedCollision | None:
        """Return the collision on a path that was just planned; None if it is free."""
        return await self._predict(self._planner.confirm(segment))

    async def _predict(self, query: Coroutine[object, object, PathCheck]) -> PredictedCollision | None:
        if self.unobserved_reason:
            query.close()
            return PredictedCollision(reason=self.unobserved_reason)
        if unavailable := self._workspace.planners.watch_unavailable_reason:
            # A moving arm would be notified too late; it waits at rest until a new process has started.
            query.close()
            return PredictedCollision(reason=f"path monitoring is not available: {unavailable}")
        try:
            async with asyncio.timeout(_CHECK_S):
                check = await query
        except TimeoutError:
            return PredictedCollision(reason=f"its path was not checked within {_CHECK_S:g} s")
        except FlexcellError as error:
            return PredictedCollision(reason=f"path monitoring is not available: {error.message}")
        if check.blocked_at_s is None:
            return None
        return PredictedCollision(reason=describe_contacts(check.pairs), at_s=check.blocked_at_s)

    async def rest_of(self, segment: PathSegment, *, from_s: float) -> str:
        """Return why a resting arm cannot follow its remaining path with the planned margin; empty if it can.

        Raises:
            RobotError: the planning process has ended.
        """
        check = await self._planner.check(segment, from_s=from_s, margin_m=segment.margin_m)
        return "" if check.blocked_at_s is None else describe_contacts(check.pairs)

    async def beside(self) -> str:
        """Return what moves near the resting arm and keeps it at rest; empty if nothing. Raises as `rest_of` does."""
        now_s = self._runner.clock.now_s()
        recent = {name for name, at_s in self._changed_s.items() if now_s - at_s < _RECENT_S}
        if not recent:
            return ""
        pairs = await self._planner.beside(self._runner.port.sample().position_rad, within_m=_APART_M)
        for _, name in pairs:
            if name.partition("/")[0].partition("~")[0] in recent or name in recent:
                return f"{describe_names(name)} moves within {_APART_M * 100:.0f} cm of the arm"
        return ""
