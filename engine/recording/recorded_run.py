"""A run in its journal: origin, events, state of the world at its end, and the executed behavior."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from engine.document import Behavior
from engine.document.substitutes import Substitutes
from engine.errors import DocumentError, FlexcellError, JournalError
from engine.event import AnyEvent, BehaviorChanged, Event, RunStarted
from engine.journal import RunOrigin, RunRecord, WorldState, journal_path, open_snapshot
from engine.recording import RecordedDocuments, collect_documents, recorded_behavior, recorded_substitutes
from engine.runtime.history.effective_events import effective_events
from engine.runtime.history.hot_change import VersionSnapshot


@dataclass(frozen=True, kw_only=True)
class RecordedRun:
    """One run of a journal, as currently stored."""

    place: Path
    record: RunRecord
    origin: RunOrigin
    events: tuple[AnyEvent, ...]
    world: WorldState | None

    @property
    def id(self) -> str:
        """The id of the run."""
        return self.record.id

    @cached_property
    def effective(self) -> tuple[Event, ...]:
        """Its events without those that were repeated after a crash."""
        return tuple(effective_events(self.events))

    @cached_property
    def document(self) -> str:
        """The content hash of the version of the behavior that it was executing last."""
        changes = [event.document for event in self.events if isinstance(event, RunStarted | BehaviorChanged)]
        return changes[-1] if changes else self.record.document

    def knows_world_at(self, seq: int) -> bool:
        """Return whether the state of the simulated world is known at an event."""
        return self.world is not None and self.world.seq == seq

    def require_event(self, seq: int) -> None:
        """Check that the run has an event.

        Raises:
            DocumentError: it has no such event.
        """
        last = self.effective[-1].seq if self.effective else 0
        if not 1 <= seq <= last:
            raise DocumentError(f"run {self.id} has no event {seq}", hint=f"it has 1 to {last}")

    def behavior(self) -> Behavior | None:
        """Return the behavior at the start of the run; None if the journal does not contain it.

        Raises:
            FlexcellError: the stored documents are damaged.
        """
        return recorded_behavior(self._documents) if self.origin.documents else None

    def behavior_now(self) -> Behavior | None:
        """Return the behavior at the end of the run, after hot changes; None if the journal does not contain it.

        Raises:
            FlexcellError: the stored documents are damaged.
        """
        changes = [event for event in self.events if isinstance(event, BehaviorChanged)]
        if not changes:
            return self.behavior()
        return changed_behavior(changes[-1])

    @property
    def substitutes(self) -> Substitutes | None:
        """The substitutes of its behavior; None if there were none.

        Raises:
            DocumentError: the document is damaged.
        """
        return recorded_substitutes(self._documents)

    @property
    def _documents(self) -> RecordedDocuments:
        texts = {name: text.encode() for name, text in self.origin.documents.items()}
        return RecordedDocuments(behavior=self.origin.document, texts=texts)


def read_run(place: Path | str, run_id: str) -> RecordedRun:
    """Read a run from a journal.

    Raises:
        JournalError: there is no such run, it is damaged, or the journal does not contain its origin.
    """
    path = journal_path(place)
    with open_snapshot(path) as journal:
        record, origin = journal.run(run_id), journal.origin(run_id)
        if origin is None:
            raise JournalError(
                f"the journal does not record how run {run_id} was started",
                where=path,
                hint="start it again from its file",
            )
        events, world = tuple(journal.events(run_id)), journal.world(run_id)
    return RecordedRun(place=path, record=record, origin=origin, events=events, world=world)


def changed_behavior(event: BehaviorChanged) -> Behavior | None:
    """Return the new version of a hot change; None if its documents were not kept.

    Raises:
        FlexcellError: they are damaged.
    """
    if not event.documents:
        return None
    texts = {name: text.encode() for name, text in event.documents.items()}
    return recorded_behavior(RecordedDocuments(behavior=event.behavior, texts=texts))


def version_snapshot(behavior: Behavior | None) -> VersionSnapshot:
    """Return the journal data of a hot change to this version; empty if its documents cannot be kept."""
    name, texts = document_snapshot(behavior) if behavior is not None else ("", {})
    return VersionSnapshot(behavior=name, documents=texts)


def document_snapshot(behavior: Behavior) -> tuple[str, dict[str, str]]:
    """Return the name and the texts under which a journal keeps a behavior; empty if that is not possible."""
    try:
        found = collect_documents(behavior)
        return found.behavior, {name: text.decode() for name, text in found.texts.items()}
    except (FlexcellError, UnicodeDecodeError):
        # A file was deleted since it was loaded: the run continues, but a changed document cannot be compared.
        return "", {}
