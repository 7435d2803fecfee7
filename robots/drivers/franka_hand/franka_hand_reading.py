"""What the transport of a Franka Hand reads and writes."""

from __future__ import annotations

from dataclasses import dataclass

from robots.drivers.franka_hand.hand_protocol import FingerState


@dataclass(frozen=True, kw_only=True)
class FrankaHandReading:
    """A state, the number of the last request that has ended, and how it has; None before the first."""

    state: FingerState
    ended: int = 0
    end_status: int | None = None

    @property
    def is_homed(self) -> bool:
        """Whether the hand knows its stroke."""
        return self.state.stroke_m > 0.0


@dataclass(frozen=True, kw_only=True)
class MoveFingers:
    """Move to an opening; the hand limits no force."""

    number: int
    width_m: float
    speed_m_s: float


@dataclass(frozen=True, kw_only=True)
class CloseFingers:
    """Close until something resists with a force."""

    number: int
    speed_m_s: float
    force_n: float


@dataclass(frozen=True, kw_only=True)
class HomeFingers:
    """Measure the stroke."""

    number: int


@dataclass(frozen=True, kw_only=True)
class StopFingers:
    """Stop."""


FrankaHandCommand = MoveFingers | CloseFingers | HomeFingers | StopFingers
