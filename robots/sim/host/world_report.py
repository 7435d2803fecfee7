"""Reports of a world's process to its parent, besides motion events."""

from __future__ import annotations

import msgspec

from robots.control.motion_event import MotionFinished, MotionHeld, MotionResumed, ReflexTripped
from robots.sim.loop.snapshot import CellSummary


class WorldReady(msgspec.Struct, frozen=True, kw_only=True, tag_field="event", tag="ready"):
    """The world is built and steps; `fifo` is true under a real-time schedule."""

    summary: CellSummary
    fifo: bool


class WorldRefused(msgspec.Struct, frozen=True, kw_only=True, tag_field="event", tag="refused"):
    """The world cannot be built."""

    message: str
    where: str = ""
    hint: str = ""


class WorldRestored(msgspec.Struct, frozen=True, kw_only=True, tag_field="event", tag="restored"):
    """The world is restored to the image, and its state can be read."""


AnyReport = WorldReady | WorldRefused | WorldRestored | MotionFinished | MotionHeld | MotionResumed | ReflexTripped
