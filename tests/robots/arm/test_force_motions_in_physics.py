"""CartAdmitDMP in physics: a tool wipes an inclined pad that gives way, and presses better from pass to pass."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import AsyncExitStack, asynccontextmanager

import numpy as np
import pytest

from engine.bus import GoalStatus, SkillBus
from engine.clock import new_clock
from engine.messages import Pose
from engine.messages.demonstrations import Trajectory
from engine.messages.primitives import CartDmp, CartOffsets, ForceReference
from engine.skills.contact import ContactResult, MoveUntilContact
from engine.skills.dmp import CartAdmitDMP, CartAdmitResult
from engine.skills.motion import JointTrapVel
from robots.arm import ArmServer
from robots.model.transform import RigidTransform, quaternion_of
from robots.motion.dmp import learn_cart_dmp
from robots.motion.min_jerk import min_jerk
from robots.scene.sim_scene import ArmPlacement, FixtureBody, SimScene
from robots.sim.world.sim_world import SimRobot, SimWorld, new_world
from tests.robots.arm.simulated import Simulated
from tests.robots.panda_arm import BASE, panda_kinematics

ABOVE = (0.0, 0.35, 0.0, -2.1, 0.0, 2.45, 0.785)
WAY_M, SLOPE, WIPE_S = 0.12, 0.04, 2.0
FORCE_N = 10.0


def pad() -> FixtureBody:
    """A plate on a spring 8 mm below the tool, rising by `SLOPE` along y."""
    thick = 0.01
    turn = quaternion_of(np.array([np.arctan(SLOPE), 0.0, 0.0]))
    tool = panda_kinematics().tool_pose(np.array(ABOVE))
    top = tool.xyz + np.array([0.0, WAY_M / 2.0, -0.008 + SLOPE * WAY_M / 2.0])
    down = RigidTransform(xyz=top, xyzw=turn).then(
        RigidTransform(xyz=np.array([0.0, 0.0, -thick / 2.0]), xyzw=quaternion_of(np.zeros(3)))
    )
    return FixtureBody(name="pad", shape="box", size_m=(0.4, 0.5, thick), pose=down.to_pose("world"), spring_n_m=5000.0)


@asynccontextmanager
async def above_the_pad() -> AsyncGenerator[Simulated]:
    """The arm at `ABOVE`, in lockstep with virtual time."""
    placement = ArmPlacement(name="left", model="panda", base=BASE.to_pose("world"), gripper="panda_hand")
    scene = SimScene(step_s=0.002, arms=(placement,), fixtures=(pad(),))
    async with AsyncExitStack() as stack:
        bus = await stack.enter_async_context(SkillBus(new_clock()))

        def make(world: SimWorld) -> tuple[SimRobot, ...]:
            port = world.arm("left")
            base = placement.base
            return (ArmServer(name="left", model=placement.robot(), base=base, port=port, clock=bus.clock),)

        world = await stack.enter_async_context(new_world(scene, virtual=True, make_robots=make))
        world.register(bus)
        for robot in world.robots():
            await stack.enter_async_context(robot)
            robot.register(bus)
        yield Simulated(bus, world)


def straight_on(start: Pose) -> CartDmp:
    """A primitive that goes level along y from `start`, which knows nothing of the slope."""
    times = np.linspace(0.0, WIPE_S, 201)
    xyz = np.array(start.xyz) + min_jerk(times / WIPE_S)[:, None] * np.array([0.0, WAY_M, 0.0])
    poses = tuple((*place, *start.xyzw) for place in xyz.tolist())
    return learn_cart_dmp(Trajectory(times_s=tuple(times.tolist()), poses=poses), kernels=20).dmp


async def wipe(cell: Simulated, offsets: CartOffsets | None) -> CartAdmitResult:
    """Go down until contact, and along while pressing."""
    await cell.perform(JointTrapVel(joints=ABOVE, speed=0.5))
    down = await cell.perform(
        MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=0.015, force_n=3.0, speed_m_s=0.03)
    )
    assert isinstance(down.result, ContactResult)
    assert down.result.contact
    force = ForceReference.constant(force_n=(0.0, 0.0, FORCE_N))
    end = await cell.perform(CartAdmitDMP(dmp=straight_on(down.result.pose), force=force, offsets=offsets))
    assert end.status is GoalStatus.SUCCEEDED, end.cause
    assert isinstance(end.result, CartAdmitResult)
    return end.result


@pytest.mark.virtual
async def test_each_pass_presses_better_than_the_one_before() -> None:
    """The rms error of the force falls over three passes."""
    passes: list[CartAdmitResult] = []
    async with above_the_pad() as cell:
        for _ in range(3):
            passes.append(await wipe(cell, passes[-1].offsets if passes else None))
    errors = [each.force_error_rms_n for each in passes]
    assert errors[1] < 0.75 * errors[0]
    assert errors[2] < 0.9 * errors[1]
    assert errors[2] < 0.6 * errors[0]
