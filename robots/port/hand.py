"""The low-level interface of a hand with one motor, simulated or real."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from robots.port.motion import Motion


@dataclass(frozen=True, kw_only=True)
class HandSample:
    """A hand measurement: closed share of its motor (0 open, 1 closed), and the contacts of the fingers.

    `force_n` is the motor's pull beyond that for closing equally far on nothing.
    """

    time_s: float
    closed_share: float
    force_n: float
    contacts: tuple[str, ...] = ()
    """Contacts with holdable bodies of each finger, thumb first, and last of the palm: a body's name if the
    device knows it, `?` for unknown, empty for none."""


class HandPort(Protocol):
    """The low-level interface of a hand with one motor."""

    @property
    def max_force_n(self) -> float:
        """Maximum pull of the motor."""
        ...

    def sample(self) -> HandSample:
        """Return the latest measurement."""
        ...

    def close_to(self, *, share: float, time_s: float) -> Motion:
        """Close (or open) to `share`, 0 to 1, in `time_s` or as fast as the motor can.

        REACHED when the motor has arrived and the fingers rest, or when it has stalled against a held object; its
        pull persists until the next command.
        """
        ...
