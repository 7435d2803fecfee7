"""What a world's process tells its parent besides what happens to motions."""

from __future__ import annotations

import msgspec

from robots.control.motion_event import MotionFinished, MotionHeld, MotionResumed, ReflexTripped
from robots.sim.loop.snapshot import CellSummary


class WorldReady(msgspec.Struct, frozen=True, kw_only=True, tag_field="event", tag="ready"):
    """The world stands and steps; `fifo` tells whether the system gave it a real-time schedule."""

    summary: CellSummary
    fifo: bool


class WorldRefused(msgspec.Struct, frozen=True, kw_only=True, tag_field="event", tag="refused"):
    """The world cannot be built."""

    message: str
    where: str = ""
    hint: str = ""


class WorldRestored(msgspec.Struct, frozen=True, kw_only=True, tag_field="event", tag="restored"):
    """The world is where the image was made, and its state can be read."""


AnyReport = WorldReady | WorldRefused | WorldRestored | MotionFinished | MotionHeld | MotionResumed | ReflexTripped
