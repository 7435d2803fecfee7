"""The interface of all devices of a cell: robots, grippers, tools, equipment modules, worlds.

A driver, simulated or real, is a plain class with these members. States never access it: they
use its skills on the bus under `name`. It belongs to the cell's event loop; its threads and
processes are its own and end in `__aexit__`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import Enum
from types import TracebackType
from typing import Protocol, Self, runtime_checkable

from engine.bus import SkillBus


class DeviceStatus(Enum):
    """The status of a device."""

    DISCONNECTED = "disconnected"
    CONNECTED = "connected"
    READY = "ready"
    MOVING = "moving"
    STOPPED = "stopped"
    FAULT = "fault"


@runtime_checkable
class Robot(Protocol):
    """A device that connects, serves skills, stops and closes."""

    @property
    def name(self) -> str:
        """The bus namespace of its skills and the resource that a run leases."""
        ...

    @property
    def status(self) -> DeviceStatus:
        """The present status."""
        ...

    def register(self, bus: SkillBus) -> None:
        """Advertise its skills and publish its description under `name`."""
        ...

    async def stop(self) -> None:
        """Decelerate to rest and return when rest is measured.

        Raises:
            RobotError: rest could not be confirmed.
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
    """A device whose connection can be lost and restored while the cell stays open."""

    @property
    def lost_reason(self) -> str:
        """Why the connection is lost; empty while it is connected."""
        ...

    def when_connection_changes(self, callback: Callable[[], None]) -> None:
        """Call `callback`, on the event loop, when the connection is lost and when it is restored."""
        ...

    async def reconnect(self) -> str:
        """Reconnect under the same names, at rest, and return the differences from before, empty for none.

        Skills, topics and leases stay valid. Does nothing while connected.

        Raises:
            RobotError: it cannot be reconnected; the hint says what to check.
        """
        ...


@runtime_checkable
class MeasurePort(Protocol):
    """A device, simulated or real, that sums up numbers while runs command it."""

    def measures(self) -> Mapping[str, float]:
        """Return the measures since it was connected, by name as in `engine.messages.measures`.

        Raises:
            RobotError: it is not connected.
        """
        ...


class World(Robot, Protocol):
    """A simulated world: creates the simulated robots and publishes scene, frames and parts.

    A killed cell is resumed in a new world with the state of the old one: `snapshot`, then `restore`.
    On a `VirtualLoop` the world attaches itself to the loop while it is open and is stepped by it.
    """

    def robots(self) -> tuple[Robot, ...]:
        """Return the simulated robots and grippers of this world, not yet connected."""
        ...

    def snapshot(self) -> bytes:
        """Return the complete state of the world; in real time it may be a few milliseconds old.

        Cheap enough for every commit of a journal. Equal states give equal bytes.

        Raises:
            RobotError: the world is not open.
        """
        ...

    async def restore(self, snapshot: bytes) -> None:
        """Restore the state of `snapshot`, at rest; world and robots are connected.

        Moving bodies are restored at rest, and a gripper still holds its part.

        Raises:
            RobotError: something moves, the world has ended, or the bytes are not a snapshot of this
                world: damaged, or of another cell, seed or version.
        """
        ...
