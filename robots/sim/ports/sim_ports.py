"""The ports of simulated arms, the same for both hosts."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from engine.errors import RobotError
from engine.skills.arm_control import ControlSettings
from robots.control.force.force_task_validation import validate_force_task
from robots.control.generators.trajectory_playback import validate_trajectory
from robots.control.laws.settings_validation import validate_settings
from robots.model.robot_model import JointLimits
from robots.port import ArmSample, Array, ContactCondition, ForceTask, JointTrajectory, StreamKind, Tolerance
from robots.sim.commands.arm_commands import (
    ConfigureArm,
    FollowTrajectory,
    RecoverArm,
    StartGuiding,
    StartStream,
    TrackForce,
)
from robots.sim.host.world_host import WorldHost
from robots.sim.loop.snapshot import ArmSummary
from robots.sim.ports.exclusive_motion import ExclusiveMotion
from robots.sim.ports.motion_registry import MotionRegistry, SimMotion
from robots.sim.ports.sim_stream import SimStream

_TWIST = 6
_REFLEX_REASON = "external force or torque limit exceeded"


class SimArmPort:
    """Implements `robots.port.ArmPort` for one arm of a simulated world.

    Methods that start a motion raise RobotError while another motion is active, after a reflex
    until `recover`, and when the world is lost.
    """

    def __init__(self, host: WorldHost, board: MotionRegistry, arm: ArmSummary, limits: JointLimits) -> None:
        self._host = host
        self._board = board
        self._arm = arm
        self._limits = limits
        self._settings = ControlSettings()
        self._one = ExclusiveMotion(arm.name, board)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Joint names in order."""
        return self._arm.joints

    @property
    def settings(self) -> ControlSettings:
        """The active settings."""
        return self._settings

    @property
    def reflex_reason(self) -> str:
        """Reason of the reflex stop; empty without one.

        The arm's state shows the reflex before the reason arrives: until then a general reason is returned.
        """
        return self._board.reflexes.get(self._arm.name, _REFLEX_REASON) if self.sample().reflex else ""

    def when_reflex(self, callback: Callable[[str], None]) -> None:
        """Call `callback` with the reason at every reflex stop."""
        self._board.when_reflex(self._arm.name, callback)

    def sample(self) -> ArmSample:
        """Return the latest measurement."""
        return self._host.snapshot().arm(self._arm.name)

    def follow(
        self, trajectory: JointTrajectory, *, tolerance: Tolerance, until: ContactCondition | None = None
    ) -> SimMotion:
        """Start following; with `until` a contact ends the motion early.

        Raises:
            RobotError: as for all motions; the trajectory does not start at the set point at rest, or the
                contact condition is invalid.
        """
        number = self._next_number()
        if until is not None:
            self._check_contact(until)
        checked = validate_trajectory(trajectory, start_rad=self._set_point(), joints=self._arm.joints)
        motion = SimMotion(number, send=self._host.send, progress=lambda: self._progress(number))
        command = FollowTrajectory(
            arm=self._arm.name, motion=number, trajectory=checked, tolerance=tolerance, until=until
        )
        return self._one.start(motion, self._host, command)

    def track_force(self, task: ForceTask, *, tolerance: Tolerance) -> SimMotion:
        """Start following a tool path under force control; the report contains a `ForceRecord`.

        Raises:
            RobotError: as for all motions, or the task is invalid at the present set point.
        """
        number = self._next_number()
        checked = validate_force_task(task, start_rad=self._set_point(), joints=self._arm.joints)
        motion = SimMotion(number, send=self._host.send, progress=lambda: self._progress(number))
        command = TrackForce(arm=self._arm.name, motion=number, task=checked, tolerance=tolerance)
        return self._one.start(motion, self._host, command)

    def stream(self, kind: StreamKind, *, watchdog_s: float) -> SimStream:
        """Start following streamed values.

        Raises:
            RobotError: as for all motions, or the watchdog time is invalid.
        """
        number = self._next_number()
        if not (math.isfinite(watchdog_s) and watchdog_s > 0.0):
            raise RobotError(f"watchdog_s cannot be {watchdog_s}", where=self._arm.name, hint="give a time above 0")
        command = StartStream(arm=self._arm.name, motion=number, kind=kind, watchdog_s=watchdog_s)
        return self._start_stream(command, width=_TWIST if kind == "tool_twist" else len(self._arm.joints))

    def guide(self, *, damping: float = 0.0) -> SimStream:
        """Float in gravity compensation.

        Raises:
            RobotError: as for all motions, or the damping is not a share.
        """
        number = self._next_number()
        if not 0.0 <= damping <= 1.0:
            raise RobotError(f"damping cannot be {damping}", where=self._arm.name, hint="give a share from 0 to 1")
        return self._start_stream(StartGuiding(arm=self._arm.name, motion=number, damping=damping), width=0)

    def configure(self, settings: ControlSettings) -> None:
        """Apply settings from the next control period on.

        Raises:
            RobotError: a value is out of range for this arm, or the world is lost.
        """
        checked = validate_settings(settings, arm=self._arm.name, joints=self._arm.joints, limits=self._limits)
        self._host.send(ConfigureArm(arm=self._arm.name, settings=checked))
        self._settings = checked

    def recover(self) -> None:
        """End a reflex stop; the arm holds its position."""
        self._host.send(RecoverArm(arm=self._arm.name))
        # The old reason must not be reported for the next reflex.
        self._board.reflexes.pop(self._arm.name, None)

    def begin(self) -> None:
        """Reset to the initial settings, for a new world."""
        self._settings = ControlSettings()

    def _next_number(self) -> int:
        number = self._one.number()
        if self.sample().reflex:
            why = self._board.reflexes.get(self._arm.name, _REFLEX_REASON)
            raise RobotError(
                f"the arm has stopped by itself: {why}",
                where=self._arm.name,
                hint="make sure that its path is clear, then recover it",
            )
        return number

    def _set_point(self) -> Array:
        return np.asarray(self.sample().desired_rad)

    def _progress(self, number: int) -> float | None:
        return self._host.snapshot().arm_progress(self._arm.name, number)

    def _start_stream(self, command: StartStream | StartGuiding, *, width: int) -> SimStream:
        number = command.motion
        stream = SimStream(
            number, arm=self._arm.name, width=width, send=self._host.send, progress=lambda: self._progress(number)
        )
        self._one.start(stream, self._host, command)
        return stream

    def _check_contact(self, contact: ContactCondition) -> None:
        length = math.hypot(*contact.direction)
        if not (math.isfinite(contact.force_n) and contact.force_n > 0.0):
            raise RobotError(
                f"the contact force cannot be {contact.force_n} N", where=self._arm.name, hint="give more than 0 N"
            )
        if length != 0.0 and not abs(length - 1.0) < 1e-3:
            raise RobotError(
                f"{contact.direction} is not a direction",
                where=self._arm.name,
                hint="give a unit vector, or zero for any",
            )
