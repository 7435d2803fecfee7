"""The low-level interface of one arm, simulated or real: measure, follow, stream, guide, track forces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, Protocol, runtime_checkable

import numpy as np

from engine.skills.arm_control import ControlSettings
from robots.port.arrays import Array
from robots.port.force_task import ForceTask
from robots.port.motion import Motion, MotionStream
from robots.port.trajectory import ContactCondition, JointTrajectory, Tolerance

StreamKind = Literal["joint_position", "joint_velocity", "tool_twist"]
"""Values of a stream: radians (n); rad/s (n); m/s and rad/s of the tool centre point in world axes (6)."""


@dataclass(frozen=True, kw_only=True)
class ArmSample:
    """One measurement: shapes (n,); `time_s` is the device's clock; `desired` is the set point.

    `external_nm` is the estimated external joint torque; `wrench` (6,) the force and
    torque of the environment on the tool at the tool centre point, world axes, without the tool's and the
    load's weight. `reflex` is true after a reflex stop; the arm then accepts no motion before `recover`.
    """

    time_s: float
    position_rad: Array
    velocity_rad_s: Array
    effort_nm: Array
    desired_rad: Array
    external_nm: Array = field(default_factory=lambda: np.zeros(0))
    wrench: Array = field(default_factory=lambda: np.zeros(6))
    reflex: bool = False


@runtime_checkable
class DelayedSettings(Protocol):
    """An arm whose controller takes a while to adopt tool and load."""

    @property
    def settings_are_applied(self) -> bool:
        """Whether the next motion is executed with the settings; true also where none can be, and in a motion."""
        ...


class ArmPort(Protocol):
    """The low-level interface of one arm; one motion at a time.

    Every method that starts a motion raises RobotError while another motion is active, after a reflex
    until `recover`, and where the device does not support it (stated in the message).
    """

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Joint names in order."""
        ...

    @property
    def settings(self) -> ControlSettings:
        """The active settings."""
        ...

    @property
    def reflex_reason(self) -> str:
        """Reason of the reflex stop (joint or force, amount, contact); empty without one."""
        ...

    def when_reflex(self, callback: Callable[[str], None]) -> None:
        """Call `callback` with the reason, on the event loop, at every reflex stop, also between motions."""
        ...

    def sample(self) -> ArmSample:
        """Return the latest measurement."""
        ...

    def follow(
        self, trajectory: JointTrajectory, *, tolerance: Tolerance, until: ContactCondition | None = None
    ) -> Motion:
        """Start following; with `until` a contact ends the motion early (REACHED, `contact` true)."""
        ...

    def track_force(self, task: ForceTask, *, tolerance: Tolerance) -> Motion:
        """Start following a tool path under force control; the report contains a `ForceRecord`."""
        ...

    def stream(self, kind: StreamKind, *, watchdog_s: float) -> MotionStream:
        """Start following streamed values within the limits of position, speed, acceleration and jerk."""
        ...

    def guide(self, *, damping: float = 0.0) -> MotionStream:
        """Float in gravity compensation so that the arm can be guided by hand; the stream takes no values.

        `damping` is the remaining share (0 to 1) of the joints' nominal damping. The motion ends by `finish` or
        `cancel`; the arm then holds its position.
        """
        ...

    def configure(self, settings: ControlSettings) -> None:
        """Apply settings from the next control period on, without a jump.

        Raises:
            RobotError: a value is out of range for this arm, or the device is lost.
        """
        ...

    def recover(self) -> None:
        """End a reflex stop; the arm holds its position. Does nothing without one."""
        ...
