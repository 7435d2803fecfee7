"""The host of a simulated world: this process in lockstep, or its own process in real time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from robots.control.motion_event import AnyMotionEvent
from robots.port import Array
from robots.sim.commands.world_commands import AnyCommand, ModulePlaced, PlaceModule
from robots.sim.loop.snapshot import CellSummary, SimSnapshot


class WorldListener(Protocol):
    """Receives the events of the world on the event loop thread."""

    def happened(self, event: AnyMotionEvent) -> None:
        """Take the event that a motion ended, was held or resumed."""
        ...

    def lost(self, reason: str) -> None:
        """Take the loss of the world; no more events follow."""
        ...


class WorldHost(Protocol):
    """A running world."""

    @property
    def summary(self) -> CellSummary:
        """Summary of the world."""
        ...

    def snapshot(self) -> SimSnapshot:
        """Return the latest state."""
        ...

    def image(self) -> Array:
        """Return the complete state, at most a few steps old, as in `ImageLayout`."""
        ...

    def measures(self) -> dict[str, float]:
        """Return what the world has summed up since it was opened or restored, by name."""
        ...

    async def restore(self, image: Array) -> None:
        """Restore an image of this world, at rest; nothing moves, and nothing may be started meanwhile.

        Raises:
            RobotError: the world is lost.
        """
        ...

    async def place_module(self, command: PlaceModule) -> ModulePlaced:
        """Plug or unplug a module between two steps; returns when its bodies are there, or why they are not.

        Raises:
            RobotError: the world is lost.
        """
        ...

    def send(self, command: AnyCommand) -> None:
        """Send a command, which acts from one of the next steps on.

        Raises:
            RobotError: the world is lost.
        """
        ...

    async def open(self, listener: WorldListener) -> None:
        """Build the world and start to notify `listener`.

        Raises:
            CellError: the world cannot be built.
            RobotError: its process does not start.
        """
        ...

    async def close(self) -> None:
        """End the world; everything in it comes to rest first."""
        ...


StepHook = Callable[[], bool]
"""Called after every step in lockstep; true when it called back into the event loop."""
