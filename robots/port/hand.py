"""The low-level face of a hand that closes with one motor, simulated or real."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from robots.port.motion import Motion


@dataclass(frozen=True, kw_only=True)
class HandSample:
    """Measured hand: how far its motor has closed it (0 open, 1 closed), and what the fingers touch.

    `force_n` is the motor's pull beyond what closing that far on nothing takes.
    """

    time_s: float
    closed_share: float
    force_n: float
    contacts: tuple[str, ...] = ()
    """What each finger, thumb first, and last the palm touch of things that can be held: a body's name where the
    device can tell, `?` for unknown, empty for nothing."""


class HandPort(Protocol):
    """The low-level face of a hand that closes with one motor."""

    @property
    def max_force_n(self) -> float:
        """The motor's greatest pull."""
        ...

    def sample(self) -> HandSample:
        """The newest measurement."""
        ...

    def close_to(self, *, share: float, time_s: float) -> Motion:
        """Close (or open) to `share`, 0 to 1, in `time_s` or as fast as the motor can.

        REACHED when the motor is there and the fingers rest, or when it has stalled against what they hold; its
        pull is kept up until the next command.
        """
        ...
