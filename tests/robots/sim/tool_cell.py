"""Cells with one arm and a tool, and how its tool centre point is brought to a pose."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import numpy as np
from scipy.spatial.transform import Rotation

from engine.messages import Pose, Quaternion, Vector3
from robots.model.inverse_kinematics import InverseKinematicsSolver
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array, MotionReport
from robots.scene.sim_scene import ArmPlacement, FixtureBody, PartBody, SimScene
from robots.sim.world.sim_world import SimWorld, new_world
from tests.robots.sim.sim_cell import move

DOWN: Quaternion = (1.0, 0.0, 0.0, 0.0)
ARM = "arm"


def scene(
    arm: str, tool: str | None, *, parts: tuple[PartBody, ...] = (), fixtures: tuple[FixtureBody, ...] = ()
) -> SimScene:
    """Return a cell with one arm at the origin."""
    placement = ArmPlacement(name=ARM, model=arm, gripper=tool, base=Pose(xyz=(0.0, 0.0, 0.0)))
    return SimScene(arms=(placement,), parts=parts, fixtures=fixtures)


def block(name: str, top_xyz: Vector3, size_m: tuple[float, float]) -> FixtureBody:
    """Return a fixed block from the floor up to `top_xyz`, the middle of its top face."""
    x, y, z = top_xyz
    return FixtureBody(name=name, shape="box", size_m=(*size_m, z), pose=Pose(xyz=(x, y, z / 2)))


class Reach:
    """One arm of an open world, told where its tool shall be."""

    def __init__(self, world: SimWorld, scene: SimScene) -> None:
        (placement,) = scene.arms
        self.world = world
        self.port = world.arm(ARM)
        self._kinematics = ArmKinematics(placement.robot(), base=RigidTransform.from_pose(placement.base))
        self._inverse = InverseKinematicsSolver(self._kinematics)

    async def to(
        self, xyz: Vector3, xyzw: Quaternion = DOWN, *, duration_s: float = 1.0, like: Array | None = None
    ) -> MotionReport:
        """Move the joints so that the tool is at a pose in the world, the arm standing `like` this or as at present."""
        target = RigidTransform(xyz=np.array(xyz), xyzw=np.array(xyzw))
        goal = self._inverse.nearest(target, seed=np.asarray(self.port.sample().desired_rad) if like is None else like)
        return await self.joints(goal, duration_s=duration_s)

    async def joints(self, goal: Array, *, duration_s: float = 1.0) -> MotionReport:
        """Move to a configuration."""
        return await move(self.port, goal, duration_s, limits=self._kinematics.limits)

    def in_tool(self, part: str) -> tuple[Array, Rotation]:
        """Return where a part is and how it is turned, as seen from the measured tool."""
        tool = self._kinematics.tool_pose(self.port.sample().position_rad)
        back = Rotation.from_quat(tool.xyzw).inv()
        xyz, turn = self.part(part)
        return back.apply(xyz - tool.xyz), back * turn

    def part(self, part: str) -> tuple[Array, Rotation]:
        """Return where a part is and how it is turned, in the world."""
        xyz, xyzw = self.world.measured().frames()
        row = self.world.host.summary.frames.index(part)
        return np.array(xyz[row]), Rotation.from_quat(xyzw[row])

    def strayed_m(self, part: str, start: Array) -> float:
        """Return how far a part is from where it was."""
        return float(np.linalg.norm(self.part(part)[0] - start))


@asynccontextmanager
async def reaching(cell: SimScene) -> AsyncGenerator[Reach]:
    """Open a world in lockstep on the running virtual loop."""
    async with new_world(cell, virtual=True) as world:
        yield Reach(world, cell)
        await world.stop()


async def slip_while_held(reach: Reach, part: str, *, seconds: float = 2.0) -> tuple[float, float]:
    """Let time pass and return how far, metres and radians, a part has moved in the tool."""
    xyz, turn = reach.in_tool(part)
    await asyncio.sleep(seconds)
    later, turned = reach.in_tool(part)
    return float(np.linalg.norm(later - xyz)), float((turned * turn.inv()).magnitude())
