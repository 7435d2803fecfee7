"""The motion skills with a given path: joint profiles and the straight line (RCL tables 3 to 5)."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

import numpy as np

from engine.bus import ActiveGoal, SkillBus
from engine.errors import SkillFailed
from engine.messages import Pose
from engine.skills.motion import (
    CartLinTask,
    CartMotionFeedback,
    CartMotionResult,
    CartTrapVel,
    ForwardKinematics,
    JointMotionFeedback,
    JointMotionResult,
    JointTrapVel,
)
from robots.arm.execution.given_path import given_path
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.execution.tool_frames import WORLD
from robots.arm.execution.trajectory_goal import follow_joints, follow_tool
from robots.model.inverse_kinematics import PoseMatch
from robots.model.transform import RigidTransform
from robots.port import Array, JointTrajectory


class PathMotions:
    """Serves JointTrapVel, CartTrapVel, CartLinTask and ForwardKinematics."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills under the arm's name."""
        name = self._runner.name
        bus.advertise_action(JointTrapVel, self._joint_trap_vel, namespace=name, exclusive=name)
        bus.advertise_action(CartTrapVel, self._cart_trap_vel, namespace=name, exclusive=name)
        bus.advertise_action(CartLinTask, self._cart_lin_task, namespace=name, exclusive=name)
        bus.advertise_service(ForwardKinematics, self._forward_kinematics, namespace=name)

    async def _joint_trap_vel(self, goal: JointTrapVel, handle: ActiveGoal[JointMotionFeedback]) -> JointMotionResult:
        runner = self._runner
        async with given_path(runner, goal.collisions) as path:
            trajectory = await path.planned(
                handle, lambda start: runner.planner.to_joints(start, np.array(goal.joints), speed=goal.speed)
            )
            return await follow_joints(runner, trajectory, handle, monitored=path.monitored)

    async def _cart_trap_vel(self, goal: CartTrapVel, handle: ActiveGoal[CartMotionFeedback]) -> CartMotionResult:
        planner, match = self._runner.planner, PoseMatch.of(goal.match)
        return await self._cartesian(
            goal, handle, lambda start, pose: planner.to_pose(start, pose, speed=goal.speed, match=match)
        )

    async def _cart_lin_task(self, goal: CartLinTask, handle: ActiveGoal[CartMotionFeedback]) -> CartMotionResult:
        planner = self._runner.planner
        return await self._cartesian(
            goal, handle, lambda start, pose: planner.along_line(start, pose, duration_s=goal.duration_s)
        )

    async def _forward_kinematics(self, request: ForwardKinematics) -> Pose:
        runner = self._runner
        if not request.joints:
            return runner.measured_pose()
        if len(request.joints) != runner.model.dof:
            raise SkillFailed(
                f"got {len(request.joints)} joints", where=runner.name, hint=f"this arm has {runner.model.dof}"
            )
        if not np.isfinite(request.joints).all():
            raise SkillFailed(f"the joints {request.joints} are not finite", where=runner.name)
        return runner.kinematics.tool_pose(np.array(request.joints)).to_pose(WORLD)

    async def _cartesian(
        self,
        goal: CartTrapVel | CartLinTask,
        handle: ActiveGoal[CartMotionFeedback],
        plan: Callable[[Array, RigidTransform], Awaitable[JointTrajectory]],
    ) -> CartMotionResult:
        runner = self._runner
        target = runner.target(goal.pose, handle)
        async with given_path(runner, goal.collisions) as path:
            trajectory = await path.planned(handle, lambda start: plan(start, target))
            return await follow_tool(runner, trajectory, handle, monitored=path.monitored)
