"""Executes a planned trajectory as the goal of a joint or tool motion skill, with its feedback and result."""

from __future__ import annotations

from collections.abc import Callable

from engine.bus import ActiveGoal
from engine.skills.arm_control import ArmMode
from engine.skills.motion import CartMotionFeedback, CartMotionResult, JointMotionFeedback, JointMotionResult
from robots.arm.execution.motion_runner import MotionRunner
from robots.port import JointTrajectory, Motion

Monitored = Callable[[Motion], Motion]
"""Returns a motion of the port, monitored."""


def unmonitored(motion: Motion) -> Motion:
    """Return the motion itself."""
    return motion


async def follow_joints(
    runner: MotionRunner,
    trajectory: JointTrajectory,
    handle: ActiveGoal[JointMotionFeedback],
    *,
    mode: ArmMode = "moving",
    monitored: Monitored = unmonitored,
) -> JointMotionResult:
    """Follow an accepted trajectory; feedback and result are the measured joints."""
    start = runner.set_point()

    def publish_feedback(motion: Motion) -> None:
        handle.feedback(JointMotionFeedback(joints=runner.measured(), progress=motion.progress))

    def measured_result(duration_s: float) -> JointMotionResult:
        return JointMotionResult(
            joints=runner.measured(), duration_s=duration_s, start=start, deviation_rad=runner.deviation_rad()
        )

    ended = await runner.carry_out(
        lambda: monitored(runner.port.follow(trajectory, tolerance=runner.tolerance)),
        handle,
        publish_feedback,
        mode=mode,
        failed_result=measured_result,
    )
    return measured_result(ended.duration_s)


async def follow_tool(
    runner: MotionRunner,
    trajectory: JointTrajectory,
    handle: ActiveGoal[CartMotionFeedback],
    *,
    mode: ArmMode = "moving",
    monitored: Monitored = unmonitored,
) -> CartMotionResult:
    """Follow an accepted trajectory; feedback and result are the measured pose of the tool."""
    start = runner.set_point()

    def measured_result(duration_s: float) -> CartMotionResult:
        return CartMotionResult(
            pose=runner.measured_pose(), duration_s=duration_s, start=start, deviation_rad=runner.deviation_rad()
        )

    ended = await runner.carry_out(
        lambda: monitored(runner.port.follow(trajectory, tolerance=runner.tolerance)),
        handle,
        lambda motion: publish_pose_feedback(runner, handle, motion),
        mode=mode,
        failed_result=measured_result,
    )
    return measured_result(ended.duration_s)


def publish_pose_feedback(runner: MotionRunner, handle: ActiveGoal[CartMotionFeedback], motion: Motion) -> None:
    """Publish feedback: the measured pose of the tool and the progress of the motion."""
    handle.feedback(CartMotionFeedback(pose=runner.measured_pose(), progress=motion.progress))
