"""The write batch of one run: its events and the state of the simulated world after them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from engine.event import Event


@dataclass(frozen=True)
class WorldState:
    """The state of the simulated world after event `seq`."""

    seq: int
    data: bytes = field(repr=False)


@dataclass(frozen=True)
class WriteBatch:
    """The data of one run for one transaction."""

    run: str
    epoch: int
    events: Sequence[Event]
    world: WorldState | None
