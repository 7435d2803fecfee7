"""What one moving arm must know of the scene around it: whether its way is free, what comes near while it rests."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Coroutine
from dataclasses import dataclass

from engine.errors import FlexcellError
from robots.arm.motion_runner import MotionRunner
from robots.arm.path_planner import PathPlanner, PathSegment, describe_contacts
from robots.planning.request import PathCheck
from robots.workspace.path_reservations import describe_names
from robots.workspace.workspace import Workspace

# A check that takes longer is none: the arm is watched by nobody.
_CHECK_S = 0.3
# What changed no longer ago than this counts as moving; so near to a resting arm it keeps the arm at rest.
_LATELY_S, _APART_M = 0.5, 0.08


@dataclass(frozen=True, kw_only=True)
class PredictedCollision:
    """Why an arm must stop, and at which instant of its way's own time it would touch; infinite where none is known."""

    reason: str
    at_s: float = math.inf


class PathMonitor:
    """Looks at the ways of one arm for one goal."""

    def __init__(self, runner: MotionRunner, finder: PathPlanner, workspace: Workspace) -> None:
        self._runner = runner
        self._finder = finder
        self._workspace = workspace
        self._changed_s: dict[str, float] = {}

    def note(self, names: frozenset[str]) -> None:
        """Remember what has changed just now."""
        now_s = self._runner.clock.now_s()
        self._changed_s.update((name, now_s) for name in names)

    @property
    def unobserved_reason(self) -> str:
        """Why nothing can be known of the scene; empty where it can."""
        stale = self._workspace.stale_reason
        return f"the occupancy map is not valid: {stale}" if stale else ""

    async def ahead(self, leg: PathSegment, *, from_s: float) -> PredictedCollision | None:
        """Return why the rest of a way that is being gone must not be; None where it is free."""
        return await self._trouble(self._finder.check(leg, from_s=from_s, margin_m=self._finder.margin_m))

    async def along(self, leg: PathSegment) -> PredictedCollision | None:
        """Return why a way that was found just now must not be gone; None where it is free."""
        return await self._trouble(self._finder.confirm(leg))

    async def _trouble(self, looking: Coroutine[object, object, PathCheck]) -> PredictedCollision | None:
        if self.unobserved_reason:
            looking.close()
            return PredictedCollision(reason=self.unobserved_reason)
        if gone := self._workspace.planners.watch_unavailable_reason:
            # Whatever moves now would be told too late; the arm waits at rest for another one to start.
            looking.close()
            return PredictedCollision(reason=f"path monitoring is not available: {gone}")
        try:
            async with asyncio.timeout(_CHECK_S):
                check = await looking
        except TimeoutError:
            return PredictedCollision(reason=f"its path was not checked within {_CHECK_S:g} s")
        except FlexcellError as error:
            return PredictedCollision(reason=f"path monitoring is not available: {error.message}")
        if check.blocked_at_s is None:
            return None
        return PredictedCollision(reason=describe_contacts(check.pairs), at_s=check.blocked_at_s)

    async def rest_of(self, leg: PathSegment, *, from_s: float) -> str:
        """Return why a resting arm cannot go the rest of its way, as far from things as it was planned; else nothing.

        Raises:
            RobotError: the planning process ended.
        """
        check = await self._finder.check(leg, from_s=from_s, margin_m=leg.margin_m)
        return "" if check.blocked_at_s is None else describe_contacts(check.pairs)

    async def beside(self) -> str:
        """Return what moves near the resting arm: that keeps it at rest. Raises as `rest_of` does."""
        now_s = self._runner.clock.now_s()
        lately = {name for name, at_s in self._changed_s.items() if now_s - at_s < _LATELY_S}
        if not lately:
            return ""
        near = await self._finder.beside(self._runner.port.sample().position_rad, within_m=_APART_M)
        for _, thing in near:
            if thing.partition("/")[0].partition("~")[0] in lately or thing in lately:
                return f"{describe_names(thing)} moves within {_APART_M * 100:.0f} cm of the arm"
        return ""
