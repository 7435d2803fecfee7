"""An arm without physics in a live scene, with planners that can be made to fail and cameras that can go blind."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from typing import Self

import numpy as np

from engine.bus import GoalHandle, SkillBus
from engine.clock import Clock, new_clock
from engine.errors import RobotError
from engine.messages import Pose
from engine.messages.sensing import NEVER_SEEN, CameraStatus, ObservedSpace, OccupancyGrid
from engine.messages.shapes import Box, Obstacle
from engine.skills.planning import FreeMotionFeedback, FreeMotionResult, MoveFree
from engine.skills.planning_scene import CollisionReport
from robots.arm import ArmServer
from robots.gripper import ToolServer
from robots.model.transform import RigidTransform
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
from robots.planning.scene.planning_scene import PlanningScene, SceneArm
from robots.planning.swept_space import SweptSpace, SweptSpaceRequest
from robots.planning.worker.inline_planner import InlinePlanner
from robots.scene.sim_scene import ArmPlacement
from robots.workspace.live_scene import LiveScene
from robots.workspace.measured_poses import MeasuredArm, MeasuredPoses
from robots.workspace.monitored_separation import MonitoredSeparation
from robots.workspace.planning_services import PlanningServices
from robots.workspace.unknown_space import UnknownSpaceRule
from robots.workspace.workspace import Workspace
from tests.robots.fake_port import FakeArmPort
from tests.robots.panda_arm import BASE, panda_kinematics, panda_model

LEFT = ArmPlacement(name="left", model="panda", base=BASE.to_pose("world"))
TABLE = Obstacle.of("table", Box(size_m=(1.6, 1.2, 0.04)), Pose(xyz=(0.0, 0.0, -0.02)))
BOX_M, VOXEL_M, SHAPE = (-0.6, -0.6, 0.1), 0.04, (30, 30, 20)


class FragilePlanner:
    """The planner of virtual time, which fails, or never answers, while it is told to; counts what it was asked."""

    def __init__(self, clock: Clock) -> None:
        self._inner = InlinePlanner(clock)
        self._clock = clock
        self.failing = ""
        self.gone = ""
        self.silent_s = 0.0
        self.plans = 0
        self.checks = 0
        self.closed = False

    def start(self) -> None:
        """Be there again."""
        self.gone = ""

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *error: object) -> None:
        self.closed = True

    async def plan(self, request: PlanRequest) -> PlanAnswer:
        """Plan."""
        self.plans += 1
        await self._fail()
        return await self._inner.plan(request)

    async def check_path(self, request: PathCheckRequest) -> PathCheck:
        """Check a way."""
        self.checks += 1
        await self._fail()
        return await self._inner.check_path(request)

    async def check_attached_parts(self, request: AttachedPartCheckRequest) -> PathCheck:
        """Check what is held on a way."""
        self.checks += 1
        await self._fail()
        return await self._inner.check_attached_parts(request)

    async def look(self, request: CollisionRequest) -> CollisionReport:
        """Look."""
        await self._fail()
        return await self._inner.look(request)

    async def pair_distances(self, request: PairDistanceRequest) -> PairDistances:
        """Return the distances of two bodies with an arm at several configurations."""
        await self._fail()
        return await self._inner.pair_distances(request)

    async def swept_space(self, request: SweptSpaceRequest) -> SweptSpace:
        """Return the unknown space on a trajectory."""
        await self._fail()
        return await self._inner.swept_space(request)

    async def _fail(self) -> None:
        if self.silent_s:
            await self._clock.sleep(self.silent_s)
        if self.failing:
            raise RobotError(self.failing, hint="plan again; a new process is started")


class FakeCameras:
    """Implements `OccupancySource`; the test says what is seen."""

    def __init__(self) -> None:
        self.latest: OccupancyGrid | None = None
        self.stale_reason = "no image yet"
        self.starting = False
        self.observed: ObservedSpace | None = None
        self.camera_statuses: tuple[CameraStatus, ...] = ()
        self.required = 0
        self.known: PlanningScene | None = None
        self.forgotten = 0
        self._subscribers: list[Callable[[], None]] = []

    def subscribe(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call `callback` at every change."""
        self._subscribers.append(callback)
        return lambda: self._subscribers.remove(callback)

    def require(self) -> None:
        """The first image is there at once."""
        self.required += 1
        if self.latest is None:
            self.see()

    def release(self) -> None:
        """Nothing is needed any more."""
        self.required -= 1

    def forget(self) -> None:
        """Begin anew."""
        self.forgotten += 1
        self.see()

    def know(self, scene: PlanningScene) -> None:
        """Keep the scene."""
        self.known = scene

    def see(self, *boxes: tuple[tuple[float, float, float], tuple[float, float, float]]) -> None:
        """See these boxes, each from its lowest corner to its highest one, metres in the world."""
        taken = np.zeros(SHAPE, dtype=bool)
        for low, high in boxes:
            first = np.floor((np.array(low) - BOX_M) / VOXEL_M).astype(int).clip(0)
            last = np.ceil((np.array(high) - BOX_M) / VOXEL_M).astype(int)
            taken[first[0] : last[0], first[1] : last[1], first[2] : last[2]] = True
        revision = self.latest.revision + 1 if self.latest is not None else 1
        self.latest = OccupancyGrid(
            time_s=0.0,
            revision=revision,
            corner_m=BOX_M,
            voxel_m=VOXEL_M,
            shape=SHAPE,
            occupied=np.packbits(taken.reshape(-1)).tobytes(),
        )
        self.go_blind("")

    def see_all_but(self, *boxes: tuple[tuple[float, float, float], tuple[float, float, float]]) -> None:
        """Have seen everything just now, but these boxes never."""
        ages = np.zeros(SHAPE, dtype=np.uint8)
        for low, high in boxes:
            first = np.floor((np.array(low) - BOX_M) / VOXEL_M).astype(int).clip(0)
            last = np.ceil((np.array(high) - BOX_M) / VOXEL_M).astype(int)
            ages[first[0] : last[0], first[1] : last[1], first[2] : last[2]] = NEVER_SEEN
        self.observed = ObservedSpace(
            time_s=0.0, corner_m=BOX_M, voxel_m=VOXEL_M, shape=SHAPE, limit_s=5.0, ages=ages.tobytes()
        )

    def go_blind(self, reason: str) -> None:
        """See nothing from now on, for this reason; empty to see again."""
        self.stale_reason = reason
        for tell in tuple(self._subscribers):
            tell()


@dataclass
class FakeCell:
    """The bus with the arm on it, and what can be made to happen."""

    bus: SkillBus
    port: FakeArmPort
    planner: FragilePlanner
    cameras: FakeCameras
    workspace: Workspace
    arm: ArmServer
    told: list[FreeMotionFeedback] = field(default_factory=list[FreeMotionFeedback])

    async def begun(self, goal: MoveFree, *, after_s: float = 0.3) -> GoalHandle[FreeMotionResult, FreeMotionFeedback]:
        """Send a goal and let it run for a while."""
        handle = self.bus.send_goal(goal, to="left")
        handle.on_feedback(self.told.append)
        await handle.accepted()
        await self.bus.clock.sleep(after_s)
        return handle

    def moves(self) -> bool:
        """Whether the arm is under way."""
        motion = self.port.motion
        return motion is not None and not motion.ended and motion.running


@asynccontextmanager
async def fake_cell(
    *,
    tool: ToolServer | None = None,
    unknown_space: UnknownSpaceRule | None = None,
    separation: MonitoredSeparation | None = None,
) -> AsyncGenerator[FakeCell]:
    """The left Panda at a table, on a bus."""
    model, clock = panda_model(), new_clock()
    port = FakeArmPort(model.arm_joints, np.array(model.home_rad))
    planner, cameras = FragilePlanner(clock), FakeCameras()

    def link(_arm: str, _link: str) -> RigidTransform:
        return panda_kinematics().tool_pose(port.sample().position_rad)

    def look() -> MeasuredPoses:
        joints = tuple(port.sample().position_rad.tolist())
        return MeasuredPoses(arms={"left": MeasuredArm(joints_rad=joints)}, parts={}, link=link)

    def make_scene() -> LiveScene:
        base = PlanningScene(arms=(SceneArm(placement=LEFT),), obstacles=(TABLE,))
        return LiveScene(base.with_allowed("left/panda_link1", "table"), parts=(), look=look)

    workspace = Workspace(
        make_scene,
        planners=PlanningServices(clock, lambda _: planner),
        clock=clock,
        occupancy=cameras,
        unknown_space=unknown_space,
        separation=separation,
    )
    arm = ArmServer(
        name="left", model=model, base=BASE.to_pose("world"), port=port, clock=clock, gripper=tool, workspace=workspace
    )
    async with SkillBus(clock) as bus, workspace, arm:
        workspace.register(bus)
        arm.register(bus)
        yield FakeCell(bus, port, planner, cameras, workspace, arm)
