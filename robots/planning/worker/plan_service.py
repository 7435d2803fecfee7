"""The interface of planning services on an event loop; planners and compilers are loaded only where needed."""

from __future__ import annotations

from typing import Any, Protocol

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


class PlanService(Protocol):
    """Answers planning requests on an event loop. All requests raise as `plan` does."""

    @property
    def gone(self) -> str:
        """Why the process has ended, so that the next answer waits for a new process to start; else empty."""
        ...

    def start(self) -> None:
        """Start the process in the background if there is none."""
        ...

    async def __aenter__(self) -> Any:
        """Start the service."""
        ...

    async def __aexit__(self, *error: object) -> None:
        """Stop the service."""
        ...

    async def plan(self, request: PlanRequest) -> PlanAnswer:
        """Return a validated path, or why there is none.

        Raises:
            CellError: the scene has no such arm, or is invalid.
            RobotError: the planning process has ended; the next request starts a new one.
        """
        ...

    async def check_path(self, request: PathCheckRequest) -> PathCheck:
        """Return the first collision of an arm that follows a trajectory."""
        ...

    async def check_attached_parts(self, request: AttachedPartCheckRequest) -> PathCheck:
        """Return the first collision of an attached part on a trajectory."""
        ...

    async def look(self, request: CollisionRequest) -> CollisionReport:
        """Return the collisions and the clearance of an arm in a configuration."""
        ...

    async def pair_distances(self, request: PairDistanceRequest) -> PairDistances:
        """Return the distances of two bodies with an arm at several configurations."""
        ...

    async def swept_space(self, request: SweptSpaceRequest) -> SweptSpace:
        """Return the unknown space that an arm passes through along a trajectory."""
        ...


def new_plan_service(clock: Clock) -> PlanService:
    """Return the planning service for a clock: inline in virtual time, else a process; enter it with `async with`."""
    if clock.virtual:
        from robots.planning.worker.inline_planner import InlinePlanner

        return InlinePlanner(clock)
    from robots.planning.worker.planning_worker import PlanningWorker

    return PlanningWorker()
