"""Plans on the event loop itself, for virtual time."""

from __future__ import annotations

from typing import Self

from engine.clock import Clock
from engine.skills.planning_scene import CollisionReport
from robots.planning.request import (
    AttachedPartCheckRequest,
    CollisionRequest,
    PathCheck,
    PathCheckRequest,
    PlanAnswer,
    PlanRequest,
)
from robots.planning.worker.scene_planner import ScenePlanner

INLINE_CHECK_S = 2e-5
"""What a check counts as in virtual time: 50,000 a second, as many as a slow machine does."""
PLAN_FIXED_S = 0.004
"""What of an answer in virtual time does not depend on the checks: both ends, timing, both ways to the process."""
LOOK_FIXED_S = 0.002
"""What a check of a way, or a look, takes in virtual time, both ways to the process among it."""


class InlinePlanner:
    """Plans on the loop itself, by effort instead of by the clock: for virtual time, where answers must repeat.

    With a clock, answers come after the time that their counted work stands for: `PLAN_FIXED_S` and what
    all checks take, or `LOOK_FIXED_S`. Without one no time passes.
    """

    def __init__(self, clock: Clock | None = None) -> None:
        self._clock = clock
        self._planner = ScenePlanner(check_s=INLINE_CHECK_S)
        self.gone = ""

    def start(self) -> None:
        """It is always there."""

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *_error: object) -> None:
        return None

    async def plan(self, request: PlanRequest) -> PlanAnswer:
        """Return a confirmed way, or why there is none. Raises CellError as `PlanService` says."""
        answer = self._planner.plan(request)
        await self._pass(PLAN_FIXED_S + self._planner.effort_s)
        return answer

    async def check_path(self, request: PathCheckRequest) -> PathCheck:
        """Return where an arm that follows a trajectory would touch something first. Raises CellError."""
        found = self._planner.check_path(request)
        await self._pass(LOOK_FIXED_S)
        return found

    async def check_attached_parts(self, request: AttachedPartCheckRequest) -> PathCheck:
        """Return where what an arm holds would touch something first on a trajectory. Raises CellError."""
        found = self._planner.check_attached_parts(request)
        await self._pass(LOOK_FIXED_S)
        return found

    async def look(self, request: CollisionRequest) -> CollisionReport:
        """Return what an arm touches in a configuration and how near it is to the rest. Raises CellError."""
        found = self._planner.look(request)
        await self._pass(LOOK_FIXED_S)
        return found

    async def _pass(self, time_s: float) -> None:
        if self._clock is not None:
            await self._clock.sleep(time_s)
