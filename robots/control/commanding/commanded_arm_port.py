"""The port of an arm whose control loop takes commands, simulated or real, here or in another process."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Protocol

import numpy as np

from engine.errors import RobotError
from engine.skills.arm_control import ControlSettings
from robots.control.commanding.arm_commands import (
    ArmCommand,
    ConfigureArm,
    FollowTrajectory,
    MotionCommand,
    RecoverArm,
    StartGuiding,
    StartStream,
    TrackForce,
)
from robots.control.commanding.commanded_stream import CommandedStream
from robots.control.commanding.exclusive_motion import ExclusiveMotion
from robots.control.commanding.motion_registry import CommandedMotion, MotionRegistry
from robots.control.force.force_task_validation import validate_force_task
from robots.control.generators.trajectory_playback import validate_trajectory
from robots.control.laws.settings_validation import validate_settings
from robots.model.robot_model import JointLimits
from robots.port import ArmSample, Array, ContactCondition, ForceTask, JointTrajectory, StreamKind, Tolerance

_TWIST = 6
_REFLEX_REASON = "external force or torque limit exceeded"


class ControlLink(Protocol):
    """The link to the control loop of one arm."""

    def send(self, command: ArmCommand | MotionCommand) -> None:
        """Send a command, which acts from one of the next periods on; raises RobotError when the loop is lost."""
        ...

    def sample(self) -> ArmSample:
        """Return the latest measurement."""
        ...

    def progress(self, motion: int) -> float | None:
        """Return the progress of a motion; None if the arm does not execute this motion."""
        ...


def at_once(_settings: ControlSettings) -> bool:
    """Return that settings act at once: in a loop that computes torques."""
    return True


class CommandedArmPort:
    """Implements `robots.port.ArmPort` and `DelayedSettings` for one arm behind a link.

    `has_settings` returns whether settings act on the next motion.

    Methods that start a motion raise RobotError while another motion is active, after a reflex
    until `recover`, while motion is not permitted, and when the control loop is lost.
    """

    def __init__(
        self,
        link: ControlLink,
        board: MotionRegistry,
        *,
        arm: str,
        joints: tuple[str, ...],
        limits: JointLimits,
        has_settings: Callable[[ControlSettings], bool] = at_once,
    ) -> None:
        self._link = link
        self._board = board
        self._arm = arm
        self._joints = joints
        self._limits = limits
        self._has_settings = has_settings
        self._settings = ControlSettings()
        self._one = ExclusiveMotion(arm, board)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Joint names in order."""
        return self._joints

    @property
    def settings_are_applied(self) -> bool:
        """Whether the next motion is executed with the active settings."""
        return self._has_settings(self._settings)

    @property
    def settings(self) -> ControlSettings:
        """The active settings."""
        return self._settings

    @property
    def reflex_reason(self) -> str:
        """Reason of the reflex stop; empty without one.

        The arm's state shows the reflex before the reason arrives: until then a general reason is returned.
        """
        return self._board.reflexes.get(self._arm, _REFLEX_REASON) if self.sample().reflex else ""

    def when_reflex(self, callback: Callable[[str], None]) -> None:
        """Call `callback` with the reason at every reflex stop."""
        self._board.when_reflex(self._arm, callback)

    def sample(self) -> ArmSample:
        """Return the latest measurement."""
        return self._link.sample()

    def follow(
        self, trajectory: JointTrajectory, *, tolerance: Tolerance, until: ContactCondition | None = None
    ) -> CommandedMotion:
        """Start following; with `until` a contact ends the motion early.

        Raises:
            RobotError: as for all motions; the trajectory does not start at the set point at rest, or the
                contact condition is invalid.
        """
        number = self._next_number()
        if until is not None:
            self._check_contact(until)
        checked = validate_trajectory(trajectory, start_rad=self._set_point(), joints=self._joints)
        motion = CommandedMotion(number, send=self._link.send, progress=lambda: self._progress(number))
        command = FollowTrajectory(arm=self._arm, motion=number, trajectory=checked, tolerance=tolerance, until=until)
        return self._one.start(motion, partial(self._link.send, command))

    def track_force(self, task: ForceTask, *, tolerance: Tolerance) -> CommandedMotion:
        """Start following a tool path under force control; the report contains a `ForceRecord`.

        Raises:
            RobotError: as for all motions, or the task is invalid at the present set point.
        """
        number = self._next_number()
        checked = validate_force_task(task, start_rad=self._set_point(), joints=self._joints)
        motion = CommandedMotion(number, send=self._link.send, progress=lambda: self._progress(number))
        command = TrackForce(arm=self._arm, motion=number, task=checked, tolerance=tolerance)
        return self._one.start(motion, partial(self._link.send, command))

    def stream(self, kind: StreamKind, *, watchdog_s: float) -> CommandedStream:
        """Start following streamed values.

        Raises:
            RobotError: as for all motions, or the watchdog time is invalid.
        """
        number = self._next_number()
        if not (math.isfinite(watchdog_s) and watchdog_s > 0.0):
            raise RobotError(f"watchdog_s cannot be {watchdog_s}", where=self._arm, hint="give a time above 0")
        command = StartStream(arm=self._arm, motion=number, kind=kind, watchdog_s=watchdog_s)
        return self._start_stream(command, width=_TWIST if kind == "tool_twist" else len(self._joints))

    def guide(self, *, damping: float = 0.0) -> CommandedStream:
        """Float in gravity compensation.

        Raises:
            RobotError: as for all motions, or the damping is not a share.
        """
        number = self._next_number()
        if not 0.0 <= damping <= 1.0:
            raise RobotError(f"damping cannot be {damping}", where=self._arm, hint="give a share from 0 to 1")
        return self._start_stream(StartGuiding(arm=self._arm, motion=number, damping=damping), width=0)

    def configure(self, settings: ControlSettings) -> None:
        """Apply settings from the next control period on.

        Raises:
            RobotError: a value is out of range for this arm, or the control loop is lost.
        """
        checked = validate_settings(settings, arm=self._arm, joints=self._joints, limits=self._limits)
        self._link.send(ConfigureArm(arm=self._arm, settings=checked))
        self._settings = checked

    def recover(self) -> None:
        """End a reflex stop; the arm holds its position."""
        self._link.send(RecoverArm(arm=self._arm))
        # The old reason must not be reported for the next reflex.
        self._board.reflexes.pop(self._arm, None)

    def begin(self) -> None:
        """Reset to the initial settings, for a new control loop."""
        self._settings = ControlSettings()

    def _next_number(self) -> int:
        number = self._one.number()
        if self.sample().reflex:
            why = self._board.reflexes.get(self._arm, _REFLEX_REASON)
            raise RobotError(
                f"the arm has stopped by itself: {why}",
                where=self._arm,
                hint="make sure that its path is clear, then recover it",
            )
        return number

    def _set_point(self) -> Array:
        return np.asarray(self.sample().desired_rad)

    def _progress(self, number: int) -> float | None:
        return self._link.progress(number)

    def _start_stream(self, command: StartStream | StartGuiding, *, width: int) -> CommandedStream:
        number = command.motion
        stream = CommandedStream(
            number, arm=self._arm, width=width, send=self._link.send, progress=lambda: self._progress(number)
        )
        self._one.start(stream, partial(self._link.send, command))
        return stream

    def _check_contact(self, contact: ContactCondition) -> None:
        length = math.hypot(*contact.direction)
        if not (math.isfinite(contact.force_n) and contact.force_n > 0.0):
            raise RobotError(
                f"the contact force cannot be {contact.force_n} N", where=self._arm, hint="give more than 0 N"
            )
        if length != 0.0 and not abs(length - 1.0) < 1e-3:
            raise RobotError(
                f"{contact.direction} is not a direction",
                where=self._arm,
                hint="give a unit vector, or zero for any",
            )
