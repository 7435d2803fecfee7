"""The write batch of one run: its record, its events, and the state of the simulated world after them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from engine.event import Event
from engine.journal.journal_port import RunOrigin


@dataclass(frozen=True)
class WorldState:
    """The state of the simulated world after event `seq`."""

    seq: int
    data: bytes = field(repr=False)


@dataclass(frozen=True, kw_only=True)
class NewRun:
    """The record of a run that begins, driven by `engine`; `document` is the behavior's content hash."""

    behavior: str
    document: str
    started_unix_s: float
    origin: RunOrigin | None
    engine: str


@dataclass(frozen=True)
class WriteBatch:
    """The data of one run for one transaction; `new` with the first of a run that begins."""

    run: str
    epoch: int
    events: Sequence[Event]
    world: WorldState | None
    new: NewRun | None = None
