"""What a world's process and its parent say to one another, besides commands and motion events."""

from __future__ import annotations

import msgspec

from robots.control.commanding.arm_commands import ControlCommand
from robots.control.motion_event import AnyMotionEvent
from robots.io.request_failure import RequestFailure
from robots.scene.sim_scene import SimScene
from robots.sim.commands.world_commands import AnyCommand, ModulePlaced, PlaceModule
from robots.sim.loop.snapshot import CellSummary


class BuildWorld(ControlCommand, frozen=True, kw_only=True, tag="build"):
    """Request: build the world and step it; always the first message, answered by `WorldReady`."""

    scene: SimScene


class WorldReady(msgspec.Struct, frozen=True, kw_only=True, tag="ready"):
    """The world is built and steps; `fifo` is true under a real-time schedule."""

    summary: CellSummary
    fifo: bool


class WorldRestored(msgspec.Struct, frozen=True, kw_only=True, tag="restored"):
    """The answer to `RestoreWorld`: the world is restored to the image, and its state can be read."""


ToWorld = BuildWorld | PlaceModule | AnyCommand
FromWorld = WorldReady | WorldRestored | ModulePlaced | RequestFailure | AnyMotionEvent
