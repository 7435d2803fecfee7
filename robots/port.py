"""What a motion server needs of an arm or gripper, simulated or real: follow, hold, resume, cancel.

Arrays are float64, joints in the model's order, radians. All members are called from the event
loop thread; an implementation may run its control elsewhere and completes futures on that loop.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ArmSample:
    """One measurement: shapes (n,); `time_s` is the device's clock; `desired` is the set point."""

    time_s: float
    position_rad: Array
    velocity_rad_s: Array
    effort_nm: Array
    desired_rad: Array


@dataclass(frozen=True, kw_only=True)
class JointTrajectory:
    """A path over time, sampled every `dt_s`: position and velocity of shape (samples, n).

    It starts at the arm's present set point at rest and ends at rest. A hold, cancel or speed
    override slows the passage along it (time scaling), so the arm never leaves the path.
    """

    dt_s: float
    position_rad: Array
    velocity_rad_s: Array


@dataclass(frozen=True, kw_only=True)
class Tolerance:
    """How far the measured joints may be off: on the way, and at the end after `settle_s` at most."""

    path_rad: float = 0.15
    goal_rad: float = 0.01
    settle_s: float = 1.0


class MotionEnd(Enum):
    """How a motion ended; after each of them the device is at rest and ready for the next."""

    REACHED = "reached"
    CANCELED = "canceled"
    FAILED = "failed"


@dataclass(frozen=True, kw_only=True)
class MotionReport:
    """The end of a motion; `reason` says in words why it failed (joint, amount, contact)."""

    end: MotionEnd
    reason: str = ""


class Motion(Protocol):
    """A motion under way."""

    @property
    def progress(self) -> float:
        """Share of the trajectory's time passed, 0 to 1."""
        ...

    async def report(self) -> MotionReport:
        """Wait for the end; may be awaited by several, and again after the end."""
        ...

    async def hold(self) -> None:
        """Decelerate on the path and return when at rest, or when the motion ended or was resumed meanwhile."""
        ...

    async def resume(self) -> None:
        """Go on along the path and return when moving, or when the motion ended or was held meanwhile."""
        ...

    def cancel(self) -> None:
        """Ask to decelerate on the path; `report` then returns CANCELED once at rest."""
        ...


@dataclass(frozen=True, kw_only=True)
class GripperSample:
    """Measured gripper: opening between the pads, commanded and measured pad force, pad contacts."""

    time_s: float
    width_m: float
    velocity_m_s: float
    force_n: float
    contacts: tuple[str, str] = field(default=("", ""))
    """What each pad touches: a body name where the device can tell, `?` for unknown, empty for nothing."""


class ArmPort(Protocol):
    """The low-level face of one arm."""

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names in order."""
        ...

    def sample(self) -> ArmSample:
        """The newest measurement."""
        ...

    def follow(self, trajectory: JointTrajectory, *, tolerance: Tolerance) -> Motion:
        """Start following; refused with RobotError while another motion runs."""
        ...


class GripperPort(Protocol):
    """The low-level face of one two-finger gripper."""

    @property
    def max_width_m(self) -> float:
        """Opening when fully open."""
        ...

    def sample(self) -> GripperSample:
        """The newest measurement."""
        ...

    def close_to(self, *, width_m: float, speed_m_s: float, force_n: float) -> Motion:
        """Move the fingers towards `width_m` (open or close), pressing with at most `force_n`.

        REACHED when the opening is reached or when the fingers have stopped against something
        and the force is built up; the force is kept up afterwards until the next command.
        """
        ...
