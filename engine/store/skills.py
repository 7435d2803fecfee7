"""Answers the entry services on the bus from a store."""

from __future__ import annotations

from engine.bus import SkillBus
from engine.skills.entries import EntryList, EntryRecord, ListEntries, ReadEntry, WriteEntry
from engine.store.contract import Store

NAMESPACE = "store"


def register_store(bus: SkillBus, store: Store) -> None:
    """Advertise reading, writing and listing of entries under `store`."""

    async def read(request: ReadEntry) -> EntryRecord:
        return await store.get(request.kind, request.name)

    async def write(request: WriteEntry) -> EntryRecord:
        return await store.put(request.kind, request.name, request.value, expected_revision=request.expected_revision)

    async def list_entries(request: ListEntries) -> EntryList:
        found = await store.list(kind=request.kind, prefix=request.prefix)
        return EntryList(entries=tuple((key.kind, key.name, key.revision) for key in found))

    bus.advertise_service(ReadEntry, read, namespace=NAMESPACE)
    bus.advertise_service(WriteEntry, write, namespace=NAMESPACE)
    bus.advertise_service(ListEntries, list_entries, namespace=NAMESPACE)
