"""Applies commands to the control loop of an arm, simulated or real."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from robots.control.arm_control_loop import ArmControlLoop
from robots.control.commanding.arm_commands import (
    ArmCommand,
    ConfigureArm,
    FinishStream,
    FollowTrajectory,
    MeasureSeparation,
    RecoverArm,
    Setpoint,
    StartGuiding,
    StartStream,
    TrackForce,
)
from robots.control.force.force_tracking import ForceTracking
from robots.control.generators.guarded_motion import GUARDED_STOP_S, GuardedMotion
from robots.control.generators.guiding import GuidingGenerator
from robots.control.generators.joint_jogging import JointJogGenerator
from robots.control.generators.joint_streaming import JointStreamGenerator
from robots.control.generators.motion_generator import MotionGenerator
from robots.control.generators.tool_jogging import ToolJogGenerator
from robots.control.generators.trajectory_playback import TrajectoryPlayback
from robots.model.robot_model import RobotModel
from robots.port import Array, Tolerance


class ArmCommandHandler:
    """Chooses the generator of each motion.

    Args:
        control: The control loop of the arm.
        model: Its model.
        measured_rad: Returns the joints at which hand guiding starts, (n,).
    """

    def __init__(self, control: ArmControlLoop, *, model: RobotModel, measured_rad: Callable[[], Array]) -> None:
        self._control = control
        self._model = model
        self._measured_rad = measured_rad
        self._acceleration_rad_s2 = np.array(model.limits.acceleration_rad_s2)
        self._jerk_rad_s3 = np.array(model.limits.jerk_rad_s3)

    def take(self, command: ArmCommand) -> None:
        """Apply a command from the next period on; numbers of other motions are ignored."""
        control = self._control
        match command:
            case FollowTrajectory():
                control.start(command.motion, self._playback(command), command.tolerance)
            case TrackForce():
                model = self._model
                tracking = ForceTracking(command.task, limits=model.limits, joints=model.arm_joints)
                control.start(command.motion, tracking, command.tolerance)
            case StartStream():
                control.start(command.motion, self._stream(command), Tolerance())
            case StartGuiding():
                control.float_with(damping_share=command.damping)
                start = control.motion.position
                guiding = GuidingGenerator(limits=self._model.limits, start=start, measured=self._measured_rad())
                control.start(command.motion, guiding, Tolerance())
            case Setpoint():
                control.motion.receive(command.motion, np.array(command.values), age_s=command.age_s)
            case FinishStream():
                control.motion.finish(command.motion)
            case ConfigureArm():
                control.configure(command.settings)
            case RecoverArm():
                control.recover()
            case MeasureSeparation():
                if control.separation is not None:
                    control.separation.take(command.measured)

    def _playback(self, command: FollowTrajectory) -> MotionGenerator:
        trajectory, limits, jerk = command.trajectory, self._acceleration_rad_s2, self._jerk_rad_s3
        if command.until is None:
            return TrajectoryPlayback(trajectory, acceleration_rad_s2=limits, jerk_rad_s3=jerk)
        inner = TrajectoryPlayback(
            trajectory, acceleration_rad_s2=limits, jerk_rad_s3=jerk, shortest_stop_s=GUARDED_STOP_S
        )
        return GuardedMotion(inner, command.until)

    def _stream(self, command: StartStream) -> MotionGenerator:
        model, start = self._model, self._control.motion.position
        match command.kind:
            case "joint_position":
                return JointStreamGenerator(
                    limits=model.limits, joints=model.arm_joints, start=start, watchdog_s=command.watchdog_s
                )
            case "joint_velocity":
                return JointJogGenerator(limits=model.limits, start=start, watchdog_s=command.watchdog_s)
            case "tool_twist":
                return ToolJogGenerator(limits=model.limits, start=start, watchdog_s=command.watchdog_s)
