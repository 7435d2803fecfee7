"""Additional interfaces of robots and devices in a simulated world."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol, runtime_checkable

from engine.robot import Robot
from robots.port import GraspCommand


class SimRobot(Robot, Protocol):
    """A robot of a simulated world that provides its memory for a restore."""

    def grips(self) -> dict[str, GraspCommand]:
        """Return the active grasp commands of its grippers, by their names."""
        ...

    def recall(self, grips: Mapping[str, GraspCommand]) -> None:
        """Restore `grips` of an earlier instance; entries of other robots are ignored."""
        ...


@runtime_checkable
class StatefulDevice(Protocol):
    """A robot or device with additional state, in its own encoding."""

    def memo(self) -> bytes:
        """Return the state to save for a restore; empty for none."""
        ...

    def remember(self, memo: bytes) -> None:
        """Restore the state from `memo`; raises RobotError if it cannot be decoded."""
        ...


@runtime_checkable
class WorldDependentDevice(Protocol):
    """A robot or device that is unavailable, and reports so, while the world is lost."""

    def world_lost(self, reason: str) -> None:
        """Reject further requests with the reason."""
        ...

    def world_restored(self) -> None:
        """Resume service; the world is restored and its ports work."""
        ...
