"""Who answers planning requests on an event loop; what plans, and the compilers for it, is loaded by who needs it."""

from __future__ import annotations

from typing import Any, Protocol

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


class PlanService(Protocol):
    """Who answers planning requests on an event loop. All of them raise as `plan` does."""

    @property
    def gone(self) -> str:
        """Why who answered is gone, so that an answer takes as long as another one takes to start; else empty."""
        ...

    def start(self) -> None:
        """Have one started in the background where none is there."""
        ...

    async def __aenter__(self) -> Any:
        """Start."""
        ...

    async def __aexit__(self, *error: object) -> None:
        """End."""
        ...

    async def plan(self, request: PlanRequest) -> PlanAnswer:
        """Return a confirmed way, or why there is none.

        Raises:
            CellError: the scene has no such arm, or something in it is wrong.
            RobotError: the planning process ended; the next request finds a new one.
        """
        ...

    async def check_path(self, request: PathCheckRequest) -> PathCheck:
        """Return where an arm that follows a trajectory would touch something first."""
        ...

    async def check_attached_parts(self, request: AttachedPartCheckRequest) -> PathCheck:
        """Return where what an arm holds would touch something first on a trajectory."""
        ...

    async def look(self, request: CollisionRequest) -> CollisionReport:
        """Return what an arm touches in a configuration and how near it is to what it must not touch."""
        ...


def new_plan_service(clock: Clock) -> PlanService:
    """Return who plans under a clock: inline in virtual time, else a process; to be entered with `async with`."""
    if clock.virtual:
        from robots.planning.worker.inline_planner import InlinePlanner

        return InlinePlanner(clock)
    from robots.planning.worker.planning_worker import PlanningWorker

    return PlanningWorker()
