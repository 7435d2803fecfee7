"""What a run asks of a journal, whichever kind it is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import msgspec

from engine.errors import JournalError
from engine.event import Event


class RunRecord(msgspec.Struct, frozen=True, kw_only=True):
    """One run as the journal knows it.

    `status` is running, or as `RunEnded` gave it: finished, stopped, errored. A run still
    `running` that no process drives was interrupted and can be resumed. `epoch` counts the engines
    that have driven it.
    """

    id: str
    behavior: str
    document: str
    status: str
    epoch: int
    started_unix_s: float
    last_seq: int
    driver: int | None = None
    """The process that drives it now, None when none does."""
    verified: bool = True
    """False where some of it was written by a version that made no checksums: damage to that cannot be told."""
    damage: str = ""
    """What of it is damaged, as far as that shows without reading its events; empty where nothing is."""

    @property
    def interrupted(self) -> bool:
        """Whether the engine that drove it has died before its end."""
        return self.status == "running" and self.driver is None and not self.damage


class RunOrigin(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """How a run was started, for whoever resumes it; paths are absolute.

    `documents` holds the texts of the behavior and of all it refers to by relative path, and
    `document` says which of them is the behavior: files change while runs are interrupted.
    `seed` is that of the cell, `run_seed` that of the run.
    """

    behavior: str
    document: str = ""
    documents: dict[str, str] = {}
    parameters: dict[str, object] = {}
    inputs: dict[str, object] = {}
    cell: str | None = None
    store: str | None = None
    seed: int | None = None
    run_seed: int = 0
    clock: str = "real"
    autonomy: str = "full"
    demand_operator: bool = False


class RunJournal(Protocol):
    """The part of a journal that belongs to one run; used on the run's event loop."""

    @property
    def run_id(self) -> str:
        """The run it belongs to."""
        ...

    @property
    def epoch(self) -> int:
        """1 for the engine that began the run, one more for each that resumed it."""
        ...

    def append(self, event: Event) -> None:
        """Take an event; it is on the disk after the next commit, or sooner. Never fails, waits for no other thread.

        The event and what it holds must not be changed afterwards. A `RunEnded` also sets the
        status of the run.
        """
        ...

    async def events(self) -> Sequence[Event]:
        """Return the events of the run so far, those of engines before this one among them.

        Raises:
            JournalError: they cannot be read, or are not kept.
        """
        ...

    async def apply_backpressure(self) -> None:
        """Return at once, unless events come faster than they are written: then as `commit`.

        Raises:
            JournalError: as `commit`.
        """
        ...

    def append_world_state(self, state: bytes) -> None:
        """Take the state of the simulated world as of now; the next commit stores it with the events."""
        ...

    def on_failure(self, listener: Callable[[JournalError], None]) -> None:
        """Call `listener` on this event loop when events cannot be written and no commit waits to be told.

        The run must stop: what it records from then on is lost.
        """
        ...

    async def commit(self) -> None:
        """Return once everything appended before is on the disk.

        Raises:
            JournalError: it could not be written, now or at an earlier commit; the run must stop.
        """
        ...


class JournalPort(Protocol):
    """Where runs are journaled."""

    def begin(
        self, run_id: str, *, behavior: str, document: str, started_unix_s: float, origin: RunOrigin | None = None
    ) -> RunJournal:
        """Enter a new run durably and return its journal; `document` is the behavior's content hash.

        Raises:
            JournalError: this run exists already, or the journal cannot be written.
        """
        ...

    def resume(self, run_id: str) -> RunJournal:
        """Take over an existing run: from now on the engine that drove it before cannot commit.

        Raises:
            JournalError: there is no such run, or the journal cannot be written.
        """
        ...

    def close(self) -> None:
        """Write what is left and release the file; may be called again.

        Raises:
            JournalError: what was left could not be written and nobody has been told yet.
        """
        ...
