"""Speed and separation monitoring of a cell as a device: sends moving arms their distances from people."""

from __future__ import annotations

import asyncio
import logging
import math
from collections.abc import Mapping
from dataclasses import replace
from types import TracebackType
from typing import Protocol, Self

from engine.bus import SkillBus, Topic
from engine.clock import Clock
from engine.errors import FlexcellError
from engine.messages.sensing import CameraStatus, OccupancyGrid
from engine.messages.separation import SeparationState
from engine.robot import DeviceStatus
from robots.control.commanding.arm_commands import MeasureSeparation
from robots.planning.scene.planning_scene import AttachedPart
from robots.port import GraspCommand, MeasuredSeparation, PermittedSpeed
from robots.scene.sim_scene import ArmPlacement, SimScene
from robots.sim.world.sim_world import SimWorld
from robots.vision.known_geometry import ArmConfiguration
from robots.vision.occupancy.arm_body import ArmBody
from robots.workspace.measured_poses import MeasuredPoses, PoseSource
from robots.workspace.monitored_separation import MonitoredSeparation
from robots.workspace.separation_measurement import (
    NearestBody,
    UnknownBodies,
    held_reach_m,
    link_extents_m,
    moving_links,
    nearest_body,
    voxel_reach_m,
)
from robots.workspace.separation_rule import SUPERVISION_S
from robots.workspace.unknown_space import describe_unhealthy
from robots.workspace.workspace import Workspace

_log = logging.getLogger("flexcell.separation")

# Smaller changes of distance and permitted share are not published.
_CHANGE_M, _CHANGE_SHARE = 0.02, 0.05


class SeparationSensor(Protocol):
    """The occupancy map with the age of what it shows."""

    @property
    def latest(self) -> OccupancyGrid | None:
        """The latest map."""
        ...

    @property
    def confirmed_age_s(self) -> float:
        """The time since which some camera has not shown what is there, infinite before two images of each."""
        ...

    @property
    def stale_reason(self) -> str:
        """Why the map is not valid."""
        ...

    @property
    def camera_statuses(self) -> tuple[CameraStatus, ...]:
        """The status of each camera."""
        ...

    def require(self) -> None:
        """Take images until as many `release` calls."""
        ...

    def release(self) -> None:
        """Undo one `require`."""
        ...


class SeparationSupervisor:
    """Implements `engine.robot.Robot` under a name that no robot has.

    While an arm has a motion, of whatever kind, it keeps the cameras running and sends the arm its distance from the
    nearest unknown body, 50 times per second. Without a valid map it sends nothing, and the arm comes to rest.

    Args:
        world: The world with the arms.
        scene: Their placements, and the step of the world.
        sensor: The occupancy map.
        workspace: Knows what the arms hold.
        separation: Takes what is measured, for the motions.
        look: Measures the cell.
        clock: The cell's clock.
    """

    name = "cell/separation"

    def __init__(
        self,
        world: SimWorld,
        scene: SimScene,
        *,
        sensor: SeparationSensor,
        workspace: Workspace,
        separation: MonitoredSeparation,
        look: PoseSource,
        clock: Clock,
    ) -> None:
        self._world = world
        self._placements = scene.arms
        self._sensor = sensor
        self._workspace = workspace
        self._separation = separation
        self._look = look
        self._clock = clock
        self._arms: dict[str, _MonitoredArm] = {}
        self._topics: dict[str, Topic[SeparationState]] = {}
        self._states = {arm.name: SeparationState(time_s=0.0, monitoring=False) for arm in scene.arms}
        self._bodies = UnknownBodies()
        self._requires = False
        self._steps = 0
        self._task: asyncio.Task[None] | None = None
        self.status = DeviceStatus.DISCONNECTED
        if clock.virtual:
            self._every = max(1, round(SUPERVISION_S / scene.step_s))
            world.each_step(self._after_step, busy=lambda: False)

    def register(self, bus: SkillBus) -> None:
        """Publish `<arm>/separation`."""
        for arm in self._placements:
            topic = bus.topic(f"{arm.name}/separation", SeparationState)
            topic.publish(self._states[arm.name])
            self._topics[arm.name] = topic

    def grips(self) -> dict[str, GraspCommand]:
        """Return no grasp commands."""
        return {}

    def recall(self, grips: Mapping[str, GraspCommand]) -> None:
        """Nothing here depends on the state of the world."""

    async def stop(self) -> None:
        """Nothing here moves."""

    async def __aenter__(self) -> Self:
        self.status = DeviceStatus.READY
        if not self._clock.virtual:
            self._task = asyncio.create_task(self._supervise(), name="separation monitoring")
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.status = DeviceStatus.DISCONNECTED
        self._require(needed=False)
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait((self._task,))
            self._task = None

    def _after_step(self) -> bool:
        """Measure if due; return whether subscribers were notified."""
        self._steps += 1
        return self._steps % self._every == 0 and self._measure()

    async def _supervise(self) -> None:
        for arm in self._placements:
            # The first time, the covering spheres of an arm take seconds.
            self._arms[arm.name] = await asyncio.to_thread(_MonitoredArm, arm)
        while True:
            await self._clock.sleep(SUPERVISION_S)
            if self._world.lost_reason:
                continue
            try:
                self._measure()
            except FlexcellError as error:
                # Nothing is sent, so that the arms come to rest.
                _log.warning("distances cannot be measured: %s", error)

    def _measure(self) -> bool:
        """Measure all moving arms; return whether subscribers were notified."""
        snapshot = self._world.measured()
        moving = [arm for arm in self._placements if snapshot.moves(arm.name)]
        self._require(needed=bool(moving))
        notified = False
        look = self._look() if moving and self._blind_reason() == "" else None
        for arm in self._placements:
            if arm not in moving:
                state = SeparationState(time_s=snapshot.time_s, monitoring=False)
            elif look is None:
                permitted = snapshot.permitted(arm.name)
                state = _state(snapshot.time_s, permitted, NearestBody(), reason=self._blind_reason())
            else:
                nearest = self._send_distance(arm, look)
                state = _state(snapshot.time_s, snapshot.permitted(arm.name), nearest)
            self._separation.record(arm.name, state)
            notified = self._publish(arm.name, state) or notified
        return notified

    def _blind_reason(self) -> str:
        sensor = self._sensor
        if sensor.stale_reason:
            return f"the occupancy map is not valid: {sensor.stale_reason}"
        if unhealthy := describe_unhealthy(sensor.camera_statuses):
            return unhealthy
        return "" if math.isfinite(sensor.confirmed_age_s) else "not every camera has taken two images yet"

    def _send_distance(self, placement: ArmPlacement, look: MeasuredPoses) -> NearestBody:
        grid = self._sensor.latest
        assert grid is not None
        if placement.name not in self._arms:
            self._arms[placement.name] = _MonitoredArm(placement)
        arm, held = self._arms[placement.name], self._workspace.attached_to(placement.name)
        nearest = arm.nearest(look, grid, self._bodies, held)
        measured = MeasuredSeparation(
            distance_m=nearest.distance_m, age_s=self._sensor.confirmed_age_s, extents_m=arm.extents_m(held)
        )
        self._world.host.send(MeasureSeparation(arm=placement.name, measured=measured))
        return nearest

    def _require(self, *, needed: bool) -> None:
        if needed == self._requires:
            return
        self._requires = needed
        if needed:
            self._sensor.require()
        else:
            self._sensor.release()

    def _publish(self, arm: str, state: SeparationState) -> bool:
        before = self._states[arm]
        if not _differs(before, state):
            return False
        self._states[arm] = state
        if arm not in self._topics:
            return False
        self._topics[arm].publish(state)
        return self._topics[arm].subscriber_count > 0


class _MonitoredArm:
    """The geometry of one arm; it takes a moment to load."""

    def __init__(self, placement: ArmPlacement) -> None:
        model = placement.robot()
        self._name = placement.name
        self._body = ArmBody(placement)
        self._moving = moving_links(self._body, model)
        self._extents_m = link_extents_m(model)

    def nearest(
        self, look: MeasuredPoses, grid: OccupancyGrid, bodies: UnknownBodies, held: tuple[AttachedPart, ...]
    ) -> NearestBody:
        """Return the nearest body; the distance is that of the surface of a voxel."""
        points = bodies.points(grid)
        if not len(points):
            return NearestBody()
        now = look.arms[self._name]
        posture = ArmConfiguration(joints=now.joints_rad, tool_joints=dict(now.tool_joints))
        balls = {link: one for link, one in self._body.link_balls(posture).items() if link in self._moving}
        held_at = [(part, look.link(self._name, part.link or self._body.tool_link)) for part in held]
        nearest = nearest_body(self._name, balls, held_at, points)
        return replace(nearest, distance_m=max(0.0, nearest.distance_m - voxel_reach_m(grid)))

    def extents_m(self, held: tuple[AttachedPart, ...]) -> tuple[float, ...]:
        """Return how far the links extend, the last one with the held parts."""
        *links, last = self._extents_m
        return (*links, last + max((held_reach_m(part) for part in held), default=0.0))


def _state(time_s: float, permitted: PermittedSpeed, nearest: NearestBody, *, reason: str = "") -> SeparationState:
    return SeparationState(
        time_s=time_s,
        monitoring=True,
        distance_m=nearest.distance_m if math.isfinite(nearest.distance_m) else None,
        nearest=nearest.body,
        at_m=nearest.at_m,
        protective_m=permitted.protective_m,
        permitted_speed_m_s=permitted.speed_m_s if math.isfinite(permitted.speed_m_s) else None,
        permitted_share=permitted.share,
        reason=reason,
    )


def _differs(before: SeparationState, now: SeparationState) -> bool:
    known = (before.monitoring, before.nearest, before.reason, before.distance_m is None, before.permitted_share == 0.0)
    if known != (now.monitoring, now.nearest, now.reason, now.distance_m is None, now.permitted_share == 0.0):
        return True
    moved_m = abs((now.distance_m or 0.0) - (before.distance_m or 0.0))
    return moved_m > _CHANGE_M or abs(now.permitted_share - before.permitted_share) > _CHANGE_SHARE
