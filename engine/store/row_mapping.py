"""Converts rows of a database to entries and changes of a store, and back."""

from __future__ import annotations

import msgspec

from engine.skills.entries import EntryRecord
from engine.store.contract import EntryChange, EntryKey
from engine.store.limits import decode_value
from engine.store.rows import RevisionRow


def record_of(row: RevisionRow) -> EntryRecord:
    """Return an entry with its value."""
    value = decode_value(row.value or "{}", where=f"{row.kind} {row.name}")
    return EntryRecord(kind=row.kind, name=row.name, value=value, revision=row.revision)


def exported_of(row: RevisionRow) -> EntryRecord:
    """Return an entry with its value and its tags."""
    return msgspec.structs.replace(record_of(row), tags=row.tags)


def key_of(row: RevisionRow) -> EntryKey:
    """Return an entry without its value."""
    return EntryKey(
        kind=row.kind,
        name=row.name,
        revision=row.revision,
        tags=row.tags,
        changed_unix_ms=row.changed_unix_ms,
        by=row.by,
    )


def change_of(row: RevisionRow) -> EntryChange:
    """Return a change with its value."""
    return EntryChange(
        kind=row.kind,
        name=row.name,
        revision=row.revision,
        value=None if row.value is None else decode_value(row.value, where=f"{row.kind} {row.name}"),
        tags=row.tags,
        changed_unix_ms=row.changed_unix_ms,
        by=row.by,
        reason=row.reason,
        restores=row.restores,
    )


def row_from(change: EntryChange, value: str | None, *, writer: str) -> RevisionRow:
    """Return a change as a row, with its value as JSON."""
    return RevisionRow(
        kind=change.kind,
        name=change.name,
        revision=change.revision,
        value=value,
        tags=change.tags,
        changed_unix_ms=change.changed_unix_ms,
        by=change.by,
        reason=change.reason,
        restores=change.restores,
        writer=writer,
    )
