"""Where a simulated world runs: in this process in lockstep, or in a process of its own in real time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from robots.control.motion_event import AnyMotionEvent
from robots.port import Array
from robots.sim.commands.world_commands import AnyCommand
from robots.sim.loop.snapshot import CellSummary, SimSnapshot


class WorldListener(Protocol):
    """Who hears, on the event loop thread, what happens in the world."""

    def happened(self, event: AnyMotionEvent) -> None:
        """A motion ended, was held or goes on."""
        ...

    def lost(self, reason: str) -> None:
        """The world is gone; nothing more will happen."""
        ...


class WorldHost(Protocol):
    """A running world."""

    @property
    def summary(self) -> CellSummary:
        """What the world consists of."""
        ...

    def snapshot(self) -> SimSnapshot:
        """Its newest state."""
        ...

    def image(self) -> Array:
        """Everything that its future depends on, now or a few steps ago, as `ImageLayout` has it."""
        ...

    async def restore(self, image: Array) -> None:
        """Go to where an image of this world was made, at rest; nothing moves, and nothing is started meanwhile.

        Raises:
            RobotError: the world is gone.
        """
        ...

    def send(self, command: AnyCommand) -> None:
        """Give a command, which acts from one of the next steps on.

        Raises:
            RobotError: the world is gone.
        """
        ...

    async def open(self, listener: WorldListener) -> None:
        """Build the world and begin to tell `listener`.

        Raises:
            CellError: it cannot be built.
            RobotError: its process does not start.
        """
        ...

    async def close(self) -> None:
        """End it; everything in it has come to rest before."""
        ...


StepHook = Callable[[], bool]
"""Called after every step in lockstep; true when it called back into the event loop."""
