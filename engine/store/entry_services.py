"""Serves the entry services of a store on the bus and publishes its changes."""

from __future__ import annotations

from collections.abc import Callable

from engine.bus import SkillBus
from engine.errors import EntryNotFound
from engine.skills.entries import (
    DeleteEntry,
    EntryChanged,
    EntryHistory,
    EntryList,
    EntryRecord,
    ListEntries,
    ReadEntry,
    ReadHistory,
    ReadRevision,
    UndoEntry,
    WriteEntry,
)
from engine.store.contract import EntryChange, Store

NAMESPACE = "store"
CHANGES = f"{NAMESPACE}/changes"
"""The topic of changes, with messages `EntryChanged`."""


def register_store(bus: SkillBus, store: Store) -> None:
    """Advertise the services that read, write, delete, undo and list entries and their history under `store`."""

    async def read(request: ReadEntry) -> EntryRecord:
        return await store.get(request.kind, request.name)

    async def write(request: WriteEntry) -> EntryRecord:
        return await store.put(
            request.kind,
            request.name,
            request.value,
            expected_revision=request.expected_revision,
            tags=request.tags,
            by=request.by,
            reason=request.reason,
        )

    async def delete(request: DeleteEntry) -> EntryChanged:
        await store.delete(
            request.kind,
            request.name,
            expected_revision=request.expected_revision,
            by=request.by,
            reason=request.reason,
        )
        return _changed((await store.history(request.kind, request.name))[-1])

    async def undo(request: UndoEntry) -> EntryChanged:
        return _changed(
            await store.undo(
                request.kind,
                request.name,
                expected_revision=request.expected_revision,
                by=request.by,
                reason=request.reason,
            )
        )

    async def list_entries(request: ListEntries) -> EntryList:
        keys = await store.list(kind=request.kind, prefix=request.prefix, tags=request.tags, text=request.text)
        return EntryList(entries=tuple((key.kind, key.name, key.revision) for key in keys))

    async def history(request: ReadHistory) -> EntryHistory:
        changes = await store.history(request.kind, request.name)
        return EntryHistory(changes=tuple(_changed(change) for change in changes))

    async def revision(request: ReadRevision) -> EntryRecord:
        changes = await store.history(request.kind, request.name)
        found = next((each for each in changes if each.revision == request.revision), None)
        if found is None or found.value is None:
            why = "was deleted by" if found else "has no"
            raise EntryNotFound(
                f"{request.kind} {request.name} {why} revision {request.revision}",
                where=NAMESPACE,
                hint="its history lists all revisions",
            )
        return EntryRecord(
            kind=found.kind, name=found.name, value=found.value, revision=found.revision, tags=found.tags
        )

    bus.advertise_service(ReadEntry, read, namespace=NAMESPACE)
    bus.advertise_service(WriteEntry, write, namespace=NAMESPACE)
    bus.advertise_service(DeleteEntry, delete, namespace=NAMESPACE)
    bus.advertise_service(UndoEntry, undo, namespace=NAMESPACE)
    bus.advertise_service(ListEntries, list_entries, namespace=NAMESPACE)
    bus.advertise_service(ReadHistory, history, namespace=NAMESPACE)
    bus.advertise_service(ReadRevision, revision, namespace=NAMESPACE)


async def publish_changes(bus: SkillBus, store: Store) -> Callable[[], None]:
    """Publish each change of the store, also of other programs, on `store/changes`; returns a function to end it."""
    topic = bus.topic(CHANGES, EntryChanged)
    return await store.follow(lambda change: topic.publish(_changed(change)))


def _changed(change: EntryChange) -> EntryChanged:
    return EntryChanged(
        kind=change.kind,
        name=change.name,
        revision=change.revision,
        deleted=change.value is None,
        tags=change.tags,
        by=change.by,
        reason=change.reason,
        changed_unix_ms=change.changed_unix_ms,
    )
