"""The low-level interface of a switchable magnet, simulated or real."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from engine.messages import HoldEvidence
from robots.port.motion import Motion


@dataclass(frozen=True, kw_only=True)
class MagnetSample:
    """A magnet measurement: whether it is switched on, what touches its face, and the pull on that."""

    time_s: float
    on: bool
    pull_n: float
    contact: str = ""
    """A body's name if the device knows it, `?` for unknown, empty for none."""
    evidence: HoldEvidence = "current"
    """What tells that something is held where the contact has no name; without `current` the pull is that of its
    model, and says nothing of it."""


class MagnetPort(Protocol):
    """The low-level interface of a switchable magnet."""

    @property
    def max_force_n(self) -> float:
        """Pull on a plate that covers its face."""
        ...

    def sample(self) -> MagnetSample:
        """Return the latest measurement."""
        ...

    def switch(self, *, on: bool) -> Motion:
        """Switch; REACHED when the field is settled. The field persists until the next command, also after a cancel."""
        ...
