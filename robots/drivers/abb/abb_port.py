"""The port of an arm behind an ABB controller: joints of the model outside, those of the controller inside."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NoReturn, Protocol

import numpy as np
from msgspec.structs import replace

from engine.errors import RobotError
from engine.skills.arm_control import ControlSettings
from robots.drivers.abb.abb_driver import ABB_IRC5
from robots.drivers.abb.abb_motion import PATIENCE_S, AbbMeasurement, AbbMotion, MotionCommands
from robots.drivers.abb.download_plan import DownloadPlan, plan_download
from robots.drivers.abb.motion_link import Done
from robots.drivers.abb.simple_message import END_DOWNLOAD, JOINTS, START_DOWNLOAD, TrajectoryPoint
from robots.drivers.abb.state_transport import STATE_PERIOD_S, AbbReading
from robots.drivers.fresh_link import FreshReading
from robots.model.joint_map import JointMap
from robots.port import (
    ArmSample,
    Array,
    ContactCondition,
    ForceTask,
    JointTrajectory,
    Motion,
    MotionStream,
    StreamKind,
    Tolerance,
)

_START_RAD = 0.02
_TO_START_RAD_S = 0.1
_PLAIN = ControlSettings()


class ArmSilenceStop(Protocol):
    """Sets whether the link stops the arm when the event loop is silent."""

    def __call__(self, *, armed: bool) -> None:
        """Set it."""
        ...


class AbbPort:
    """Implements `robots.port.ArmPort`: trajectories only.

    External torques and the wrench are zeros: the controller does not report them. Its set point is taken to be the
    measured position.

    Args:
        name: The arm, for messages.
        joint_names: Of the model.
        joint_map: From the joints of the model to the axes of the controller.
        min_duration_s: Shortest time between two points of a download.
        max_deviation_rad: Largest deviation of a download from its path.
        has_loads: Whether the controller has the loads that are set, so that they need not be sent.
        patience_s: How much longer than planned a motion may take.
        blocked: Returns why the arm may not move; empty if it may.
        download: Sends points.
        stop: Requests a stop.
        arm: Sets whether the link stops the arm when the event loop is silent.
        panel_speed: Returns the share of the speed that the controller permits, 0 to 1.
    """

    def __init__(
        self,
        name: str,
        *,
        joint_names: tuple[str, ...],
        joint_map: JointMap,
        min_duration_s: float,
        max_deviation_rad: float,
        has_loads: bool = False,
        patience_s: float = PATIENCE_S,
        blocked: Callable[[], str],
        download: Callable[[list[TrajectoryPoint]], Done],
        stop: Callable[[], Done],
        arm: ArmSilenceStop,
        panel_speed: Callable[[], float],
    ) -> None:
        self._name = name
        self._names = joint_names
        self._map = joint_map
        self._min_duration_s = min_duration_s
        self._max_deviation_rad = max_deviation_rad
        self._has_loads = has_loads
        self._patience_s = patience_s
        self._blocked = blocked
        self._submit = download
        self._arm = arm
        self._panel_speed = panel_speed
        self._commands = MotionCommands(self._download, stop)
        self._settings = ControlSettings()
        self._motion: AbbMotion | None = None
        self._measured: AbbMeasurement | None = None
        self._velocity: Array = np.zeros(len(joint_names))
        self._may_move = False
        self.idle_since_s = -math.inf
        """When the last motion ended, on the monotonic clock of readings."""

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Joint names of the model, in order."""
        return self._names

    @property
    def settings(self) -> ControlSettings:
        """The active settings."""
        return self._settings

    @property
    def reflex_reason(self) -> str:
        """Always empty: there is no reflex."""
        return ""

    @property
    def motion(self) -> AbbMotion | None:
        """The active motion."""
        return self._motion if self._motion is not None and not self._motion.ended else None

    @property
    def may_move(self) -> bool:
        """Whether rest was not measured since the last motion."""
        motion, measured = self._motion, self._measured
        open_end = motion is not None and (motion.result is None or not motion.result.at_rest)
        return open_end or self._may_move or (measured is not None and measured.in_motion)

    def when_reflex(self, callback: Callable[[str], None]) -> None:
        """Do nothing: there is no reflex."""

    def recover(self) -> None:
        """Do nothing: there is no reflex."""

    def sample(self) -> ArmSample:
        """Return the latest measurement, however old it is: `time_s` is when it was asked for."""
        measured = self._measured
        if measured is None:
            raise RobotError("nothing was measured yet", where=self._name)
        zeros = np.zeros(len(self._names))
        return ArmSample(
            time_s=measured.asked_s,
            position_rad=measured.position_rad,
            velocity_rad_s=self._velocity,
            effort_nm=zeros,
            desired_rad=measured.position_rad,
            external_nm=zeros,
        )

    def follow(
        self, trajectory: JointTrajectory, *, tolerance: Tolerance, until: ContactCondition | None = None
    ) -> Motion:
        """Download a trajectory.

        Raises:
            RobotError: a contact condition is given; the arm may not move, moves already, or stands elsewhere; or
                the download would deviate too much.
        """
        if until is not None:
            self._refuse("contacts are not measured: a motion cannot end at one", "use a force sensor on the PLC side")
        reason = self._blocked()
        if reason:
            raise RobotError(reason, where=self._name)
        if self.motion is not None:
            raise RobotError("another motion is active", where=self._name, hint="wait for its end or cancel it")
        start = self.sample().position_rad
        away_rad = float(np.abs(trajectory.position_rad[0] - start).max())
        if away_rad > _START_RAD:
            raise RobotError(
                f"the trajectory starts {away_rad:.3f} rad from where the arm stands",
                where=self._name,
                hint="plan anew",
            )
        self._motion = AbbMotion(
            trajectory,
            self._commands,
            joint_names=self._names,
            tolerance=tolerance,
            speed=lambda: self._settings.speed_override,
            panel_speed=self._panel_speed,
            patience_s=self._patience_s,
        )
        self._arm(armed=True)
        return self._motion

    def track_force(self, task: ForceTask, *, tolerance: Tolerance) -> Motion:
        """Refuse: raises RobotError."""
        self._refuse(ABB_IRC5.lacks("force"))

    def stream(self, kind: StreamKind, *, watchdog_s: float) -> MotionStream:
        """Refuse: raises RobotError."""
        self._refuse(ABB_IRC5.lacks("stream"), "simple_message has trajectories only; use short motions, or `egm`")

    def guide(self, *, damping: float = 0.0) -> MotionStream:
        """Refuse: raises RobotError."""
        self._refuse(ABB_IRC5.lacks("guide"), "jog the arm with the FlexPendant in manual mode")

    def configure(self, settings: ControlSettings) -> None:
        """Apply the speed override and the tool centre point; raises RobotError for what the controller cannot do.

        A change of speed in a motion stops it, and downloads the rest of its path.
        """
        if not 0.0 < settings.speed_override <= 1.0:
            raise RobotError(f"speed_override cannot be {settings.speed_override}", where=self._name)
        if not np.isfinite((*settings.tool_xyz_m, *settings.tool_xyzw)).all():
            raise RobotError("the tool centre point is not finite", where=self._name)
        if settings.load_kg != 0.0 and not self._has_loads:
            hint = "define it in the tooldata of the controller, and say so to the driver: `loads: defined_there`"
            self._refuse("the load cannot be set from here", hint)
        adopted = {
            "tool_xyz_m": settings.tool_xyz_m,
            "tool_xyzw": settings.tool_xyzw,
            "load_kg": settings.load_kg,
            "load_com_m": settings.load_com_m,
            "speed_override": settings.speed_override,
        }
        if replace(_PLAIN, **adopted) != settings:
            self._refuse(f"{ABB_IRC5.lacks('torque')}, and no collision reflex")
        changed = settings.speed_override != self._settings.speed_override
        self._settings = settings
        if changed and self.motion is not None:
            self.motion.change_speed()

    def take(self, reading: FreshReading[AbbReading]) -> None:
        """Apply a reading."""
        axes = np.array(reading.value.joints_rad[: len(self._names)])
        in_motion = bool(reading.value.status.in_motion)  # what is unknown counts as in motion
        measured = AbbMeasurement(asked_s=reading.asked_s, position_rad=self._map.to_model(axes), in_motion=in_motion)
        last, self._measured = self._measured, measured
        self._may_move = self._may_move and in_motion
        if last is not None:
            # Messages that were late come together: their times do not tell their distance.
            elapsed_s = max(measured.asked_s - last.asked_s, STATE_PERIOD_S)
            self._velocity = (measured.position_rad - last.position_rad) / elapsed_s
        if self._motion is not None:
            self._motion.take(measured)
            if self._motion.ended:
                self._motion = None
                self._arm(armed=False)
                self.idle_since_s = reading.asked_s

    def fail(self, reason: str, *, at_rest: bool) -> None:
        """End the active motion as failed, without a request to the controller."""
        if self._motion is not None:
            self._motion.fail(reason, at_rest=at_rest)
            self._motion, self._may_move = None, not at_rest
        self._arm(armed=False)

    def plan(self, trajectory: JointTrajectory) -> DownloadPlan:
        """Return the points of a trajectory at the present speed; raises RobotError where they deviate too much."""
        plan = plan_download(trajectory, speed=self._settings.speed_override, min_duration_s=self._min_duration_s)
        if plan.deviation_rad > self._max_deviation_rad:
            raise RobotError(
                f"{len(plan.position_rad)} points deviate by {plan.deviation_rad:.4f} rad from the path, more than "
                f"{self._max_deviation_rad:g} rad",
                where=self._name,
                hint="split the motion, move slower in its curves, or raise `max_deviation_rad` of the driver",
            )
        return plan

    def _download(self, trajectory: JointTrajectory) -> tuple[Done, float]:
        plan = self.plan(trajectory)
        durations = plan.duration_s.copy()
        if self._measured is not None:
            to_start = float(np.abs(plan.position_rad[0] - self._measured.position_rad).max())
            durations[0] = max(durations[0], to_start / _TO_START_RAD_S)
        axes = self._map.to_device(plan.position_rad)
        return self._submit(trajectory_points(axes, durations)), float(durations.sum())

    def _refuse(self, reason: str, hint: str = "see the documentation of the driver") -> NoReturn:
        raise RobotError(reason, where=self._name, hint=hint)


def trajectory_points(axes: Array, durations_s: Array) -> list[TrajectoryPoint]:
    """Return the messages of a download, of two points at least: the last one starts the motion."""
    if len(axes) == 1:
        axes, durations_s = np.vstack((axes, axes)), np.concatenate((durations_s, durations_s))
    last = len(axes) - 1
    return [
        TrajectoryPoint(
            sequence=START_DOWNLOAD if number == 0 else END_DOWNLOAD if number == last else number,
            joints_rad=(*axes[number].tolist(), *(0.0,) * (JOINTS - axes.shape[1])),
            duration_s=float(durations_s[number]),
        )
        for number in range(last + 1)
    ]
