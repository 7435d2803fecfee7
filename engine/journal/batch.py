"""What one run wants written in one transaction: its events, and the simulated world at their end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from engine.event import Event


@dataclass(frozen=True)
class WorldState:
    """The simulated world as it was when event `seq` was the last."""

    seq: int
    data: bytes = field(repr=False)


@dataclass(frozen=True)
class WriteBatch:
    """What one run wants written."""

    run: str
    epoch: int
    events: Sequence[Event]
    world: WorldState | None
