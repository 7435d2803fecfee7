"""Plans inline on the event loop, for virtual time."""

from __future__ import annotations

from typing import Self

from engine.clock import Clock
from engine.skills.planning_scene import CollisionReport
from robots.planning.request import (
    AttachedPartCheckRequest,
    CollisionRequest,
    PairDistanceRequest,
    PairDistances,
    PathCheck,
    PathCheckRequest,
    PlanAnswer,
    PlanRequest,
)
from robots.planning.swept_space import SweptSpace, SweptSpaceRequest
from robots.planning.worker.scene_planner import ScenePlanner

INLINE_CHECK_S = 2e-5
"""Virtual duration of a check: 50,000 per second, as on a slow machine."""
PLAN_FIXED_S = 0.004
"""Virtual duration of a plan besides its checks: endpoints, timing, communication with the process."""
LOOK_FIXED_S = 0.002
"""Virtual duration of a path check or a collision query, including communication with the process."""


class InlinePlanner:
    """Plans inline with a budget of counted work: for virtual time, where answers must be reproducible.

    With a clock, answers arrive after the virtual duration of their work: `PLAN_FIXED_S` plus the time of
    all checks, or `LOOK_FIXED_S`. Without a clock no time passes.
    """

    def __init__(self, clock: Clock | None = None) -> None:
        self._clock = clock
        self._planner = ScenePlanner(check_s=INLINE_CHECK_S)
        self.gone = ""

    def start(self) -> None:
        """Do nothing: an inline planner is always ready."""

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *_error: object) -> None:
        return None

    async def plan(self, request: PlanRequest) -> PlanAnswer:
        """Return a validated path, or why there is none. Raises CellError as `PlanService.plan` does."""
        answer = self._planner.plan(request)
        await self._pass(PLAN_FIXED_S + self._planner.effort_s)
        return answer

    async def check_path(self, request: PathCheckRequest) -> PathCheck:
        """Return the first collision of an arm that follows a trajectory. Raises CellError."""
        result = self._planner.check_path(request)
        await self._pass(LOOK_FIXED_S)
        return result

    async def check_attached_parts(self, request: AttachedPartCheckRequest) -> PathCheck:
        """Return the first collision of an attached part on a trajectory. Raises CellError."""
        result = self._planner.check_attached_parts(request)
        await self._pass(LOOK_FIXED_S)
        return result

    async def look(self, request: CollisionRequest) -> CollisionReport:
        """Return the collisions and the clearance of an arm in a configuration. Raises CellError."""
        result = self._planner.look(request)
        await self._pass(LOOK_FIXED_S)
        return result

    async def pair_distances(self, request: PairDistanceRequest) -> PairDistances:
        """Return the distances of two bodies with an arm at several configurations. Raises CellError."""
        result = self._planner.pair_distances(request)
        await self._pass(LOOK_FIXED_S)
        return result

    async def swept_space(self, request: SweptSpaceRequest) -> SweptSpace:
        """Return the unknown space on a trajectory. Raises CellError."""
        result = self._planner.swept_space(request)
        await self._pass(LOOK_FIXED_S)
        return result

    async def _pass(self, time_s: float) -> None:
        if self._clock is not None:
            await self._clock.sleep(time_s)
