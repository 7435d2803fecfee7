"""The low-level interface of one two-finger gripper, simulated or real."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

from engine.messages import HoldEvidence
from robots.port.motion import Motion


@dataclass(frozen=True, kw_only=True)
class GripperSample:
    """A gripper measurement: opening between the pads, commanded and measured pad force, pad contacts."""

    time_s: float
    width_m: float
    velocity_m_s: float
    force_n: float
    contacts: tuple[str, str] = field(default=("", ""))
    """Contact of each pad: a body name if the device knows it, `?` for unknown, empty for none."""
    evidence: HoldEvidence = "width"
    """What tells that something is held where no contact has a name; without `width` opening and force are those that
    were commanded, and say nothing of it."""


class GripperPort(Protocol):
    """The low-level interface of one two-finger gripper."""

    @property
    def max_width_m(self) -> float:
        """Opening when fully open."""
        ...

    @property
    def max_force_n(self) -> float:
        """Maximum grip force."""
        ...

    def sample(self) -> GripperSample:
        """Return the latest measurement."""
        ...

    def close_to(self, *, width_m: float, speed_m_s: float, force_n: float) -> Motion:
        """Move the fingers towards `width_m` (open or close), pressing with at most `force_n`.

        Force and speed are clipped to the gripper's range.

        REACHED when the opening is reached or when the fingers have stopped against an object
        and the force is built up; the force persists until the next command.
        """
        ...
