"""The low-level face of one two-finger gripper, simulated or real."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

from robots.port.motion import Motion


@dataclass(frozen=True, kw_only=True)
class GripperSample:
    """Measured gripper: opening between the pads, commanded and measured pad force, pad contacts."""

    time_s: float
    width_m: float
    velocity_m_s: float
    force_n: float
    contacts: tuple[str, str] = field(default=("", ""))
    """What each pad touches: a body name where the device can tell, `?` for unknown, empty for nothing."""


class GripperPort(Protocol):
    """The low-level face of one two-finger gripper."""

    @property
    def max_width_m(self) -> float:
        """Opening when fully open."""
        ...

    @property
    def max_force_n(self) -> float:
        """Greatest force that it can press with."""
        ...

    def sample(self) -> GripperSample:
        """The newest measurement."""
        ...

    def close_to(self, *, width_m: float, speed_m_s: float, force_n: float) -> Motion:
        """Move the fingers towards `width_m` (open or close), pressing with at most `force_n`.

        A force weaker or a speed slower or faster than the gripper can do is brought into its range.

        REACHED when the opening is reached or when the fingers have stopped against something
        and the force is built up; the force is kept up afterwards until the next command.
        """
        ...
