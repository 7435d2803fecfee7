"""What a simulated world asks of its robots and devices beyond being robots."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol, runtime_checkable

from engine.robot import Robot
from robots.gripper.grasp_check import GraspCommand


class SimRobot(Robot, Protocol):
    """A robot of a simulated world, which tells what it must know again after a restore."""

    def grips(self) -> dict[str, GraspCommand]:
        """What its grippers were told to grasp and hold, by their names."""
        ...

    def recall(self, grips: Mapping[str, GraspCommand]) -> None:
        """Know from now on what `grips` of an earlier life told, other robots' included."""
        ...


@runtime_checkable
class StatefulDevice(Protocol):
    """A robot or device that knows more than that, in words of its own."""

    def memo(self) -> bytes:
        """What it must know again after a restore; empty for nothing."""
        ...

    def remember(self, memo: bytes) -> None:
        """Know again what `memo` of an earlier life says; raises RobotError where it cannot be read."""
        ...


@runtime_checkable
class WorldDependentDevice(Protocol):
    """A robot or device that cannot work while the world is lost, and says so."""

    def world_lost(self, reason: str) -> None:
        """Take nothing more, and tell why."""
        ...

    def world_restored(self) -> None:
        """Work again; the world is restored and its ports work."""
        ...
