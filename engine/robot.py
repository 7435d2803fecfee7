"""The contract of everything a cell connects: robots, grippers, tools, equipment modules, worlds.

A driver, simulated or real, is a plain class with these members. States never see it: they
meet its skills on the bus under `name`. It belongs to the cell's event loop; whatever threads
or processes it needs are its own and end in `__aexit__`.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from types import TracebackType
from typing import Protocol, Self, runtime_checkable

from engine.bus import SkillBus


class DeviceStatus(Enum):
    """Where a device stands between unplugged and moving."""

    DISCONNECTED = "disconnected"
    CONNECTED = "connected"
    READY = "ready"
    MOVING = "moving"
    STOPPED = "stopped"
    FAULT = "fault"


@runtime_checkable
class Robot(Protocol):
    """A device that connects, answers skills, stops and closes."""

    @property
    def name(self) -> str:
        """The bus namespace of its skills and the resource that a run leases."""
        ...

    @property
    def status(self) -> DeviceStatus:
        """Where it stands now."""
        ...

    def register(self, bus: SkillBus) -> None:
        """Advertise its skills and publish its description under `name`."""
        ...

    async def stop(self) -> None:
        """Decelerate to standstill and return when measured at rest.

        Raises:
            RobotError: standstill could not be confirmed.
        """
        ...

    async def __aenter__(self) -> Self:
        """Connect; raises RobotError with the device's address and what to check."""
        ...

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Come to rest and disconnect."""
        ...


@runtime_checkable
class Reconnectable(Protocol):
    """A device whose connection can be lost and made anew while the cell stays open."""

    @property
    def lost_reason(self) -> str:
        """Why the connection is lost, in words; empty while it stands."""
        ...

    def when_connection_changes(self, tell: Callable[[], None]) -> None:
        """Call `tell`, on the event loop, when the connection is lost and when it is back."""
        ...

    async def reconnect(self) -> str:
        """Connect again under the same names, at rest, and return what is not as it was before, empty for nothing.

        Skills, topics and leases go on working. Does nothing while the connection stands.

        Raises:
            RobotError: it does not come back, with what to check.
        """
        ...


class World(Robot, Protocol):
    """Simulated surroundings: makes the simulated robots and publishes scene, frames and parts.

    A cell that was killed goes on in a new world, brought to where the old one was: `snapshot`, then
    `restore`. On a `VirtualLoop` it attaches itself to the loop while it is open and is stepped by it.
    """

    def robots(self) -> tuple[Robot, ...]:
        """The simulated robots and grippers that live in this world, not yet connected."""
        ...

    def snapshot(self) -> bytes:
        """Return everything needed to go on from here; in real time it may be a few milliseconds old.

        Cheap enough for every commit of a journal. Equal states give equal bytes.

        Raises:
            RobotError: the world is not open.
        """
        ...

    async def restore(self, snapshot: bytes) -> None:
        """Bring everything to where `snapshot` was made, at rest; world and robots are connected.

        Whatever moved stands still there, and what a gripper held it still holds.

        Raises:
            RobotError: something moves, the world is gone, or these bytes are no snapshot of this very
                world: damaged, or of another cell, seed or version.
        """
        ...
