"""The motion through a list of waypoints: joint lines with blended corners, as one trajectory."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.bus import ActiveGoal, SkillBus
from engine.errors import GoalRejected, RobotError
from engine.skills.waypoints import FollowWaypoints, Waypoint, WaypointsFeedback, WaypointsResult
from robots.arm.execution.given_path import GivenPath, given_path
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.execution.validate_numbers import are_numbers
from robots.model.inverse_kinematics import PoseMatch
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.motion.waypoint_path import waypoint_joints
from robots.port import Array, JointTrajectory, Motion


@dataclass(frozen=True, kw_only=True)
class WaypointPlan:
    """The configurations of the waypoints, the trajectory through them, and when it passes each."""

    waypoints: tuple[tuple[float, ...], ...]
    trajectory: JointTrajectory
    passed_s: tuple[float, ...]

    def passed(self, progress: float) -> int:
        """Return how many waypoints are behind the arm at a share of the trajectory's time."""
        if progress >= 1.0:
            return len(self.passed_s)
        return min(bisect_right(self.passed_s, progress * self.trajectory.duration_s), len(self.passed_s) - 1)


class WaypointMotions:
    """Serves FollowWaypoints."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner

    def register(self, bus: SkillBus) -> None:
        """Advertise the skill under the arm's name."""
        name = self._runner.name
        bus.advertise_action(FollowWaypoints, self._follow_waypoints, namespace=name, exclusive=name)

    async def _follow_waypoints(self, goal: FollowWaypoints, handle: ActiveGoal[WaypointsFeedback]) -> WaypointsResult:
        runner = self._runner
        targets = [self._target(index, waypoint, handle) for index, waypoint in enumerate(goal.waypoints)]
        plans: list[WaypointPlan] = []

        def plan(kinematics: ArmKinematics, start: Array) -> JointTrajectory:
            plans.append(plan_waypoints(kinematics, start, targets, goal))
            return plans[-1].trajectory

        async with given_path(runner, goal.collisions) as path:
            trajectory = await path.planned(
                handle, lambda start: runner.planner.make(lambda kinematics: plan(kinematics, start))
            )
            return await self._follow(plans[-1], trajectory, path, handle)

    async def _follow(
        self, plan: WaypointPlan, trajectory: JointTrajectory, path: GivenPath, handle: ActiveGoal[WaypointsFeedback]
    ) -> WaypointsResult:
        runner = self._runner
        start, passed = runner.set_point(), 0

        def publish(motion: Motion) -> None:
            nonlocal passed
            passed = plan.passed(motion.progress)
            waypoint = min(passed, len(plan.waypoints) - 1)
            handle.feedback(WaypointsFeedback(joints=runner.measured(), progress=motion.progress, waypoint=waypoint))

        def result(duration_s: float) -> WaypointsResult:
            return WaypointsResult(
                joints=runner.measured(),
                duration_s=duration_s,
                start=start,
                deviation_rad=runner.deviation_rad(),
                waypoints=plan.waypoints,
                passed=passed,
            )

        ended = await runner.carry_out(
            lambda: path.monitored(runner.port.follow(trajectory, tolerance=runner.tolerance)),
            handle,
            publish,
            failed_result=result,
        )
        return result(ended.duration_s)

    def _target(self, index: int, waypoint: Waypoint, handle: ActiveGoal[WaypointsFeedback]) -> Array | RigidTransform:
        """Return the joints of a waypoint, or its pose in the world; raises GoalRejected if it is neither."""
        where = f"waypoints[{index}]"
        if bool(waypoint.joints) == (waypoint.pose is not None):
            raise GoalRejected(f"{where}: give either `joints` or `pose`", where=handle.address)
        if waypoint.pose is None:
            if not are_numbers(waypoint.joints):
                raise GoalRejected(f"{where}: the joints are not numbers", where=handle.address)
            return np.array(waypoint.joints, dtype=np.float64)
        try:
            return self._runner.frames.to_world(waypoint.pose)
        except RobotError as error:
            raise GoalRejected(f"{where}: {error.message}", where=handle.address, hint=error.hint) from None


def plan_waypoints(
    kinematics: ArmKinematics, start: Array, targets: Sequence[Array | RigidTransform], goal: FollowWaypoints
) -> WaypointPlan:
    """Return the trajectory from `start` through the targets of a goal.

    Raises:
        RobotError: a waypoint cannot be reached, or the motion is not possible; the message says why.
    """
    # Compiled functions, which take a while to load.
    from robots.planning.timing.waypoint_timing import time_waypoints

    path = waypoint_joints(kinematics, start, targets, match=PoseMatch.of(goal.match))
    timed = time_waypoints(
        path,
        blends_m=(0.0, *(waypoint.blend_m for waypoint in goal.waypoints)),
        tool_position=lambda joints: kinematics.tool_pose(joints).xyz,
        limits=kinematics.model.limits,
        speed=goal.speed,
        speed_m_s=goal.speed_m_s,
    )
    return WaypointPlan(
        waypoints=tuple(tuple(row) for row in path[1:].tolist()), trajectory=timed.trajectory, passed_s=timed.passed_s
    )
