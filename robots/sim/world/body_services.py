"""The services of a simulated world that act on bodies as hands would: push one, reset the parts."""

from __future__ import annotations

import math
from collections.abc import Callable

from engine.bus import LeaseTable, SkillBus
from engine.errors import RobotError, SkillFailed
from engine.messages import Vector3
from engine.skills.simulated_world import LONGEST_PUSH_S, PushBody, PushBodyResult, ResetParts, ResetPartsResult
from robots.sim.commands.world_commands import PushSimBody
from robots.sim.commands.world_commands import ResetFreeParts as ResetPartsCommand
from robots.sim.host.world_host import WorldHost
from robots.sim.world.module_services import ModuleServices


class BodyServices:
    """Rejects what the world cannot do now, and sends the rest to it.

    Args:
        world: The namespace of the world on the bus.
        host: Where the world runs.
        arms: The names of its arms.
        is_moving: Returns whether something moves.
        modules: The modules, whose parts are reset too.
    """

    def __init__(
        self,
        world: str,
        host: WorldHost,
        *,
        arms: tuple[str, ...],
        is_moving: Callable[[], bool],
        modules: ModuleServices,
    ) -> None:
        self._world = world
        self._host = host
        self._arms = arms
        self._is_moving = is_moving
        self._modules = modules
        self._leases = LeaseTable()

    def register(self, bus: SkillBus) -> None:
        """Advertise the services."""
        self._leases = bus.leases
        bus.advertise_service(ResetParts, self._reset_parts, namespace=self._world)
        bus.advertise_service(PushBody, self._push_body, namespace=self._world)

    def push(self, body: str, *, force_n: Vector3, duration_s: float, at_m: Vector3 = (0.0, 0.0, 0.0)) -> None:
        """Push a body, as `SimWorld.push` does, with its errors."""
        if body not in self._host.summary.bodies:
            raise RobotError(
                f"there is no body {body}", where=self._world, hint="see the names in `host.summary.bodies`"
            )
        if not all(map(math.isfinite, (*force_n, *at_m, duration_s))):
            raise RobotError("a push has values that are not finite", where=self._world)
        if not 0.0 < duration_s <= LONGEST_PUSH_S:
            raise RobotError(
                f"a push of {duration_s:g} s", where=self._world, hint=f"push for up to {LONGEST_PUSH_S:g} s"
            )
        self._host.send(PushSimBody(push=PushBody(body=body, force_n=force_n, duration_s=duration_s, at_m=at_m)))

    async def _push_body(self, request: PushBody) -> PushBodyResult:
        self.push(request.body, force_n=request.force_n, duration_s=request.duration_s, at_m=request.at_m)
        return PushBodyResult(body=request.body)

    async def _reset_parts(self, request: ResetParts) -> ResetPartsResult:
        """Reset the parts; raises SkillFailed while a run leases an arm or something moves."""
        owners = {arm: owner for arm in self._arms if (owner := self._leases.owner(arm)) is not None}
        for arm, owner in owners.items():
            raise SkillFailed(
                f"{arm} is commanded by run {owner}", where=self._world, hint="wait for its end or stop it"
            )
        if self._is_moving():
            raise SkillFailed("something moves", where=self._world, hint="stop it first")
        self._host.send(ResetPartsCommand())
        self._modules.parts_were_reset()
        return ResetPartsResult(parts=tuple(part.name for part in self._modules.scene.parts))
