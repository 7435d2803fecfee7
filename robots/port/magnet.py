"""The low-level face of a switchable magnet, simulated or real."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from robots.port.motion import Motion


@dataclass(frozen=True, kw_only=True)
class MagnetSample:
    """Measured magnet: whether it is switched on, what touches its face, and how hard it pulls at that."""

    time_s: float
    on: bool
    pull_n: float
    contact: str = ""
    """A body's name where the device can tell, `?` for unknown, empty for nothing."""


class MagnetPort(Protocol):
    """The low-level face of a switchable magnet."""

    @property
    def max_force_n(self) -> float:
        """How hard it pulls at a plate that covers its face."""
        ...

    def sample(self) -> MagnetSample:
        """The newest measurement."""
        ...

    def switch(self, *, on: bool) -> Motion:
        """Switch; REACHED when the field is settled. It stays so until the next command, also when cancelled."""
        ...
