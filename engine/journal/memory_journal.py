"""A journal of one run in memory: for replays, in which a step back reads earlier events."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from engine.errors import JournalError
from engine.event import Event


@dataclass(kw_only=True)
class MemoryRunJournal:
    """Keeps every event in memory."""

    run_id: str
    epoch: int = 1
    kept: list[Event] = field(default_factory=list[Event])

    def append(self, event: Event) -> None:
        """Keep the event."""
        self.kept.append(event)

    async def events(self) -> Sequence[Event]:
        """Return the events."""
        return tuple(self.kept)

    async def apply_backpressure(self) -> None:
        """Return at once."""

    def append_world_state(self, state: bytes) -> None:
        """Discard it: a run in memory is never resumed."""

    def on_failure(self, listener: Callable[[JournalError], None]) -> None:
        """Ignore the listener: nothing fails."""

    async def commit(self) -> None:
        """Return at once; nothing is durable."""
