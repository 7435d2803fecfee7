"""A journal that stores nothing: for benchmarks and for `--journal none`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from engine.errors import JournalError
from engine.event import Event
from engine.journal.journal_port import RunOrigin


@dataclass(frozen=True, kw_only=True)
class NullRunJournal:
    """Discards every event."""

    run_id: str
    epoch: int = 1

    def append(self, event: Event) -> None:
        """Discard the event."""

    async def events(self) -> Sequence[Event]:
        """Raise JournalError: no events are stored."""
        hint = "run it with --journal DIR"
        raise JournalError("this run has no journal of its events", where=self.run_id, hint=hint)

    async def apply_backpressure(self) -> None:
        """Return at once."""

    def append_world_state(self, state: bytes) -> None:
        """Discard it."""

    def on_failure(self, listener: Callable[[JournalError], None]) -> None:
        """Ignore the listener: nothing fails."""

    async def commit(self) -> None:
        """Return at once; nothing is durable."""


class NullJournal:
    """Starts and resumes any run and writes nothing."""

    def begin(
        self, run_id: str, *, behavior: str, document: str, started_unix_s: float, origin: RunOrigin | None = None
    ) -> NullRunJournal:
        """Return a journal that discards events."""
        return NullRunJournal(run_id=run_id)

    def resume(self, run_id: str) -> NullRunJournal:
        """Return a journal that discards events."""
        return NullRunJournal(run_id=run_id)

    def close(self) -> None:
        """Do nothing."""
