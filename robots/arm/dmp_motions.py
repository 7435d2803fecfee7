"""Dynamic movement primitives of one arm: executed in joint or tool space, and learned (RCL 4.3.5, 4.3.6)."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, TypeVar

import msgspec
import numpy as np

from engine.bus import ActiveGoal, SkillBus
from engine.errors import RobotError, SkillFailed
from engine.messages import Pose
from engine.messages.demonstrations import Trajectory
from engine.messages.primitives import CartDmp
from engine.skills.dmp import CartDMP, JointDMP, LearnCartDmp, LearnedCartDmp, LearnedJointDmp, LearnJointDmp
from engine.skills.entries import ReadEntry
from engine.skills.motion import CartMotionFeedback, CartMotionResult, JointMotionFeedback, JointMotionResult
from engine.store import decode_entry
from robots.arm.execution.given_path import given_path
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.execution.tool_frames import WORLD
from robots.arm.execution.trajectory_goal import follow_joints, follow_tool
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.motion.dmp import learn_cart_dmp, learn_joint_dmp, plan_cart_dmp, plan_joint_dmp
from robots.port import Array, JointTrajectory

L = TypeVar("L")

_STORE, _KIND = "store", "trajectory"


class DmpMotions:
    """Serves JointDMP, CartDMP, LearnJointDmp and LearnCartDmp."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner
        self._bus: SkillBus | None = None

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills under the arm's name; learning moves nothing and needs no lease."""
        name = self._runner.name
        self._bus = bus
        bus.advertise_action(JointDMP, self._joint_dmp, namespace=name, exclusive=name)
        bus.advertise_action(CartDMP, self._cart_dmp, namespace=name, exclusive=name)
        bus.advertise_service(LearnJointDmp, self._learn_joint_dmp, namespace=name)
        bus.advertise_service(LearnCartDmp, self._learn_cart_dmp, namespace=name)

    async def _joint_dmp(self, goal: JointDMP, handle: ActiveGoal[JointMotionFeedback]) -> JointMotionResult:
        runner = self._runner
        target = np.array(goal.goal) if goal.goal else None

        def plan(kinematics: ArmKinematics, start: Array) -> JointTrajectory:
            model = kinematics.model
            return plan_joint_dmp(
                goal.dmp,
                start,
                limits=model.limits,
                joint_names=model.arm_joints,
                goal=target,
                start_reach_rad=goal.start_reach_rad,
            )

        async with given_path(runner, goal.collisions) as path:
            trajectory = await path.planned(
                handle, lambda start: runner.planner.make(lambda kinematics: plan(kinematics, start))
            )
            return await follow_joints(runner, trajectory, handle, monitored=path.monitored)

    async def _cart_dmp(self, goal: CartDMP, handle: ActiveGoal[CartMotionFeedback]) -> CartMotionResult:
        runner = self._runner
        target = None if goal.goal is None else runner.target(goal.goal, handle)
        frame = frame_of(runner, goal.dmp, handle)

        def plan(kinematics: ArmKinematics, start: Array) -> JointTrajectory:
            return plan_cart_dmp(
                kinematics,
                goal.dmp,
                start,
                frame=frame,
                goal=target,
                start_reach_m=goal.start_reach_m,
                start_reach_rad=goal.start_reach_rad,
            )

        async with given_path(runner, goal.collisions) as path:
            trajectory = await path.planned(
                handle, lambda start: runner.planner.make(lambda kinematics: plan(kinematics, start))
            )
            return await follow_tool(runner, trajectory, handle, monitored=path.monitored)

    async def _learn_joint_dmp(self, request: LearnJointDmp) -> LearnedJointDmp:
        recorded = await self._recording(request)
        names = self._runner.model.arm_joints
        if recorded.names and recorded.names != names:
            raise SkillFailed(
                f"the recording has the joints {', '.join(recorded.names)}",
                where=self._runner.name,
                hint=f"this arm has {', '.join(names)}",
            )
        # The planner may use its own kinematics for a motion at the same time.
        kinematics = self._runner.kinematics.twin()
        return await self._learned(
            lambda: learn_joint_dmp(
                recorded,
                kernels=request.N,
                a_z=request.a_z,
                a_x=request.a_x,
                trim=request.trim,
                tool_at=lambda joints: kinematics.tool_pose(joints).xyz,
            )
        )

    async def _learn_cart_dmp(self, request: LearnCartDmp) -> LearnedCartDmp:
        recorded = await self._recording(request)
        # The planner may use its own kinematics for a motion at the same time.
        kinematics = self._runner.kinematics.twin()

        def learn() -> LearnedCartDmp:
            taken = recorded if recorded.poses else with_poses(recorded, kinematics)
            return learn_cart_dmp(taken, kernels=request.N, a_z=request.a_z, a_x=request.a_x, trim=request.trim)

        return await self._learned(learn)

    async def _learned(self, learn: Callable[[], L]) -> L:
        """Learn in parallel to the planner, so that no motion waits for it."""
        runner = self._runner
        try:
            with np.errstate(all="ignore"):
                return learn() if runner.clock.virtual else await asyncio.to_thread(learn)
        except RobotError as error:
            raise SkillFailed(error.message, where=runner.name, hint=error.hint) from None
        except (ArithmeticError, ValueError) as error:
            raise SkillFailed(
                f"no primitive can be learned from these numbers: {error}",
                where=runner.name,
                hint="check the recording and the gains for values that are too large or too small",
            ) from error

    async def _recording(self, request: LearnJointDmp | LearnCartDmp) -> Trajectory:
        if request.trajectory is not None:
            return request.trajectory
        assert self._bus is not None
        return decode_entry(await self._bus.call(ReadEntry(kind=_KIND, name=request.entry), to=_STORE), Trajectory)


def frame_of(runner: MotionRunner, dmp: CartDmp, handle: ActiveGoal[Any]) -> RigidTransform:
    """Return the world pose of the frame of a primitive; raises GoalRejected for an unknown frame."""
    return runner.target(Pose(xyz=(0.0, 0.0, 0.0), frame=dmp.frame), handle)


def with_poses(recorded: Trajectory, kinematics: ArmKinematics) -> Trajectory:
    """Return the recording with the tool poses of its joints, in the world.

    Raises:
        RobotError: the number of joints differs from the arm's.
    """
    if any(len(joints) != kinematics.dof for joints in recorded.joints[:1]):
        raise RobotError(f"the recording has {len(recorded.joints[0])} joints", hint=f"this arm has {kinematics.dof}")
    tools = [kinematics.tool_pose(np.array(joints)) for joints in recorded.joints]
    poses = tuple((*tool.xyz.tolist(), *tool.xyzw.tolist()) for tool in tools)
    return msgspec.structs.replace(recorded, poses=poses, frame=WORLD)
