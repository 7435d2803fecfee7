"""The planning services of a cell: one plans paths, the other monitors the paths of moving arms."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable

from engine.clock import Clock
from engine.errors import FlexcellError
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
from robots.planning.worker.plan_service import PlanService, new_plan_service

_log = logging.getLogger("flexcell.workspace")


class PlanningServices:
    """Two services, so that no check waits for a long search; each starts at its first use.

    Args:
        clock: In virtual time one inline service takes both roles.
        make: Creates a service.
    """

    def __init__(self, clock: Clock, make: Callable[[Clock], PlanService] | None = None) -> None:
        self._clock = clock
        self._make = make or new_plan_service
        self._services: dict[str, PlanService] = {}
        self._starting: asyncio.Task[None] | None = None
        self._closed = False

    async def plan(self, request: PlanRequest) -> PlanAnswer:
        """Return a validated path, or why there is none."""
        if self.watch_unavailable_reason:
            # Monitoring is needed as soon as an arm moves.
            self._service("watch").start()
        return await self._service("plans").plan(request)

    async def check_path(self, request: PathCheckRequest) -> PathCheck:
        """Return where a path is blocked."""
        return await self._service("watch").check_path(request)

    async def confirm_path(self, request: PathCheckRequest) -> PathCheck:
        """Return where a path that was just planned is blocked; asks the service that planned it, which is faster."""
        return await self._service("plans").check_path(request)

    async def check_attached_parts(self, request: AttachedPartCheckRequest) -> PathCheck:
        """Return where an attached part collides on a path."""
        return await self._service("watch").check_attached_parts(request)

    async def look(self, request: CollisionRequest) -> CollisionReport:
        """Return the collisions of an arm."""
        return await self._service("watch").look(request)

    async def pair_distances(self, request: PairDistanceRequest) -> PairDistances:
        """Return the distances of two bodies with an arm at several configurations."""
        return await self._service("watch").pair_distances(request)

    async def swept_space(self, request: SweptSpaceRequest) -> SweptSpace:
        """Return the unknown space that an arm passes through; asks the service that planned the trajectory."""
        return await self._service("plans").swept_space(request)

    @property
    def watch_unavailable_reason(self) -> str:
        """Why path checks are not available now: the process has died and its successor is not ready; else empty."""
        return self._service("watch").gone

    def begin(self) -> None:
        """Start both services in the background."""
        if self._starting is None and not self._clock.virtual:
            self._starting = asyncio.create_task(self._start(), name="starting the planners")

    async def close(self) -> None:
        """Stop both services."""
        starting, self._starting = self._starting, None
        self._closed = True
        if starting is not None:
            starting.cancel()
            await asyncio.wait((starting,))
        services, self._services = self._services, {}
        for service in services.values():
            await service.__aexit__(None, None, None)

    async def _start(self) -> None:
        for role in ("watch", "plans"):
            try:
                await self._service(role).__aenter__()
            except FlexcellError as error:
                # No caller is waiting yet; the first call starts it again and reports why it does not start.
                _log.warning("a planning service does not start: %s", error)

    def _service(self, role: str) -> PlanService:
        name = "both" if self._clock.virtual else role
        service = self._services.get(name)
        if service is None:
            service = self._services[name] = self._make(self._clock)
        return service
