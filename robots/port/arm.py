"""The low-level face of one arm, simulated or real: measure, follow, stream, guide, track forces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, Protocol

import numpy as np

from robots.port.arrays import Array
from robots.port.force_task import ForceTask
from robots.port.motion import Motion, MotionStream
from robots.port.settings import ArmSettings
from robots.port.trajectory import ContactCondition, JointTrajectory, Tolerance

StreamKind = Literal["joint_position", "joint_velocity", "tool_twist"]
"""What a stream is told: radians (n); rad/s (n); m/s and rad/s of the tool centre point in world axes (6)."""


@dataclass(frozen=True, kw_only=True)
class ArmSample:
    """One measurement: shapes (n,); `time_s` is the device's clock; `desired` is the set point.

    `external_nm` is the joint torque that the environment causes, estimated; `wrench` (6,) the force and
    torque of the environment on the tool at the tool centre point, world axes, without the tool's and the
    load's weight. `reflex` tells that the arm has stopped by itself and takes no motion before `recover`.
    """

    time_s: float
    position_rad: Array
    velocity_rad_s: Array
    effort_nm: Array
    desired_rad: Array
    external_nm: Array = field(default_factory=lambda: np.zeros(0))
    wrench: Array = field(default_factory=lambda: np.zeros(6))
    reflex: bool = False


class ArmPort(Protocol):
    """The low-level face of one arm; one motion at a time.

    Every method that starts a motion raises RobotError while another one runs, while a reflex is
    not recovered from, and where the device cannot do it (the message says so).
    """

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names in order."""
        ...

    @property
    def settings(self) -> ArmSettings:
        """What is in force."""
        ...

    @property
    def reflex_reason(self) -> str:
        """Why the arm has stopped by itself, in words (joint or force, amount, contact); empty where it has not."""
        ...

    def when_reflex(self, tell: Callable[[str], None]) -> None:
        """Call `tell` with the reason, on the event loop, whenever the arm stops by itself, also between motions."""
        ...

    def sample(self) -> ArmSample:
        """The newest measurement."""
        ...

    def follow(
        self, trajectory: JointTrajectory, *, tolerance: Tolerance, until: ContactCondition | None = None
    ) -> Motion:
        """Start following; with `until` a contact on the way ends the motion (REACHED, `contact` true)."""
        ...

    def track_force(self, task: ForceTask, *, tolerance: Tolerance) -> Motion:
        """Start following a tool path while pressing as wanted; the report carries a `ForceRecord`."""
        ...

    def stream(self, kind: StreamKind, *, watchdog_s: float) -> MotionStream:
        """Start doing what is sent; limits of position, speed, acceleration and jerk are kept."""
        ...

    def guide(self, *, damping: float = 0.0) -> MotionStream:
        """Float in gravity compensation so that the arm can be led by hand; nothing is sent.

        `damping` is a share (0 to 1) of the nominal damping of the joints that is left. It ends by `finish` or
        `cancel`, and the arm then holds itself where it is.
        """
        ...

    def configure(self, settings: ArmSettings) -> None:
        """Put settings into force from the next control period on, without a jump.

        Raises:
            RobotError: a value is out of its range for this arm, or the device is gone.
        """
        ...

    def recover(self) -> None:
        """End a reflex; the arm holds itself where it stands. Does nothing where there is none."""
        ...
