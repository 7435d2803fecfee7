"""The guarded move: a straight line that ends at a contact force."""

from __future__ import annotations

import math

import numpy as np

from engine.bus import ActiveGoal, SkillBus
from engine.errors import GoalRejected
from engine.skills.contact import ContactResult, MoveUntilContact
from engine.skills.motion import CartMotionFeedback
from robots.arm.execution.given_path import given_path
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.execution.tool_frames import WORLD
from robots.arm.execution.trajectory_goal import publish_pose_feedback
from robots.model.transform import RigidTransform
from robots.motion.min_jerk import PEAK_SPEED
from robots.port import Array, ContactCondition, JointTrajectory, Motion
from robots.port.wrench import to_wrench

_NO_DIRECTION = 1e-6


class ContactMotions:
    """Serves MoveUntilContact."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner

    def register(self, bus: SkillBus) -> None:
        """Advertise the skill under the arm's name."""
        name = self._runner.name
        bus.advertise_action(MoveUntilContact, self._until_contact, namespace=name, exclusive=name)

    async def _until_contact(self, goal: MoveUntilContact, handle: ActiveGoal[CartMotionFeedback]) -> ContactResult:
        runner = self._runner
        runner.require_ready(handle)
        start = runner.kinematics.tool_pose(runner.port.sample().desired_rad)
        direction = self._direction(goal, start, handle)
        if not math.isfinite(goal.distance_m):
            raise GoalRejected(f"{goal.distance_m} m is not a distance", where=handle.address, hint="`distance_m: 0.1`")
        end = RigidTransform(xyz=start.xyz + goal.distance_m * direction, xyzw=start.xyzw)
        duration_s = PEAK_SPEED * goal.distance_m / goal.speed_m_s
        async with given_path(runner, goal.collisions, tool_contact="ends_path") as path:
            trajectory = await path.planned(
                handle, lambda joints: runner.planner.along_line(joints, end, duration_s=duration_s)
            )
            before = runner.measured_tool()
            ended = await runner.carry_out(
                lambda: path.monitored(self._follow(trajectory, goal.force_n, direction)),
                handle,
                lambda motion: publish_pose_feedback(runner, handle, motion),
            )
        measured, wrench = runner.measured_tool(), runner.port.sample().wrench
        return ContactResult(
            contact=ended.report.contact,
            pose=measured.to_pose(WORLD),
            travelled_m=float((measured.xyz - before.xyz) @ direction),
            force_n=float(-wrench[:3] @ direction),
            wrench=to_wrench(wrench),
            duration_s=ended.duration_s,
        )

    def _direction(self, goal: MoveUntilContact, tool: RigidTransform, handle: ActiveGoal[CartMotionFeedback]) -> Array:
        """Return the unit vector of the motion in the world, (3,)."""
        length = math.hypot(*goal.direction)
        if not math.isfinite(length) or length < _NO_DIRECTION:
            raise GoalRejected(
                f"{goal.direction} is not a direction", where=handle.address, hint="[0, 0, -1] points down in the world"
            )
        return self._runner.frames.axes(goal.frame, tool=tool) @ (np.array(goal.direction) / length)

    def _follow(self, trajectory: JointTrajectory, force_n: float, direction: Array) -> Motion:
        runner = self._runner
        x, y, z = (-direction).tolist()
        until = ContactCondition(force_n=force_n, direction=(x, y, z))
        return runner.port.follow(trajectory, tolerance=runner.tolerance, until=until)
