"""The journal interface that runs use, independent of the implementation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import msgspec

from engine.errors import JournalError
from engine.event import Event


class RunRecord(msgspec.Struct, frozen=True, kw_only=True):
    """The record of one run in the journal.

    `status` is running, or the status of `RunEnded`: finished, stopped, errored. A run that is still
    `running` but driven by no process was interrupted and can be resumed. `epoch` counts the engines
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
    """The process id of the engine that drives the run; None when there is none."""
    verified: bool = True
    """False where a version without checksums wrote a part of the run: damage to that part cannot be detected."""
    damage: str = ""
    """The damage found without reading the events; empty when there is none."""

    @property
    def interrupted(self) -> bool:
        """Whether the engine that drove the run died before the run's end."""
        return self.status == "running" and self.driver is None and not self.damage


class RunOrigin(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """The start parameters of a run, needed to resume it; paths are absolute.

    `documents` holds the texts of the behavior and of all documents that it refers to, by relative path;
    `document` names the behavior among them: files may change while a run is interrupted.
    `simulated` names the devices of the cell whose drivers the simulation replaced, `real` those that were driven; None
    where an earlier version did not record it.
    `seed` is the seed of the cell, `run_seed` the seed of the run.
    """

    behavior: str
    document: str = ""
    documents: dict[str, str] = {}
    parameters: dict[str, object] = {}
    inputs: dict[str, object] = {}
    cell: str | None = None
    simulated: tuple[str, ...] = ()
    real: tuple[str, ...] | None = None
    store: str | None = None
    seed: int | None = None
    run_seed: int = 0
    clock: str = "real"
    autonomy: str = "full"
    demand_operator: bool = False


class RunJournal(Protocol):
    """The journal of one run; used on the run's event loop."""

    @property
    def run_id(self) -> str:
        """The id of the run."""
        ...

    @property
    def epoch(self) -> int:
        """1 for the engine that started the run, plus 1 for each that resumed it."""
        ...

    def append(self, event: Event) -> None:
        """Append an event; it is on disk after the next commit or earlier. Never fails and never blocks.

        The event and its contents must not be changed afterwards. A `RunEnded` also sets the
        status of the run.
        """
        ...

    async def events(self) -> Sequence[Event]:
        """Return the events of the run so far, including those of earlier engines.

        Raises:
            JournalError: the events cannot be read, or are not stored.
        """
        ...

    async def apply_backpressure(self) -> None:
        """Return at once, or wait as `commit` does when too many events are pending.

        Raises:
            JournalError: as in `commit`.
        """
        ...

    def append_world_state(self, state: bytes) -> None:
        """Append the present state of the simulated world; the next commit stores it with the events."""
        ...

    def on_failure(self, listener: Callable[[JournalError], None]) -> None:
        """Call `listener` on this event loop when events cannot be written and no commit is waiting.

        The run must stop: later events are lost.
        """
        ...

    async def commit(self) -> None:
        """Return when all appended events are on disk.

        Raises:
            JournalError: an event could not be written, now or at an earlier commit; the run must stop.
        """
        ...


class JournalPort(Protocol):
    """A journal of runs."""

    def begin(
        self, run_id: str, *, behavior: str, document: str, started_unix_s: float, origin: RunOrigin | None = None
    ) -> RunJournal:
        """Have a new run stored, and return its journal; `document` is the behavior's content hash.

        It is durable after the next commit of the run, or earlier. Never waits for a disk while an event loop runs that
        others share.

        Raises:
            JournalError: the run already exists, or the journal cannot be written; otherwise the next commit raises it.
        """
        ...

    def resume(self, run_id: str) -> RunJournal:
        """Take over an existing run: the engine that drove it before can no longer commit.

        Raises:
            JournalError: there is no such run, or the journal cannot be written.
        """
        ...

    def close(self) -> None:
        """Write all pending events and close the file; may be called again.

        Raises:
            JournalError: pending events could not be written and no commit has reported it.
        """
        ...
