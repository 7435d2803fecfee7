"""Named entries over the bus, answered under `store` (RCY 2.2)."""

from __future__ import annotations

import msgspec

from engine.messages import Message
from engine.skill import Service


class EntryRecord(Message, frozen=True, kw_only=True, omit_defaults=True):
    """A named entry as stored: `value` has the fields of its `kind`; `revision` counts its changes.

    `tags` is None where nothing is said of them.
    """

    kind: str
    name: str
    value: dict[str, object]
    revision: int
    tags: tuple[str, ...] | None = None


class ReadEntry(Service[EntryRecord], frozen=True, kw_only=True):
    """Return the entry `name` of `kind`; fails with the near names when there is none."""

    kind: str
    name: str


class WriteEntry(Service[EntryRecord], frozen=True, kw_only=True):
    """Write an entry; with `expected_revision`, only when the stored one still has it.

    `tags` replace those it has, None keeps them. `by` and `reason` say in its history who wrote it and why.
    """

    kind: str
    name: str
    value: dict[str, object]
    expected_revision: int | None = None
    tags: tuple[str, ...] | None = None
    by: str = ""
    reason: str = ""


class EntryChanged(Message, frozen=True, kw_only=True):
    """One change of an entry: by whom, when (UTC, milliseconds since 1970) and why; `store/changes` has each."""

    kind: str
    name: str
    revision: int
    deleted: bool
    tags: tuple[str, ...] = ()
    by: str = ""
    reason: str = ""
    changed_unix_ms: int = 0


class DeleteEntry(Service[EntryChanged], frozen=True, kw_only=True):
    """Remove an entry; its history stays, and `undo_entry` brings it back."""

    kind: str
    name: str
    expected_revision: int | None = None
    by: str = ""
    reason: str = ""


class UndoEntry(Service[EntryChanged], frozen=True, kw_only=True):
    """Bring back what an entry was before its last change; again, one step further into the past."""

    kind: str
    name: str
    expected_revision: int | None = None
    by: str = ""
    reason: str = ""


class EntryHistory(Message, frozen=True, kw_only=True):
    """Every change of an entry, oldest first."""

    changes: tuple[EntryChanged, ...] = ()


class ReadHistory(Service[EntryHistory], frozen=True, kw_only=True):
    """Return every change of an entry; none when it never was."""

    kind: str
    name: str


class ReadRevision(Service[EntryRecord], frozen=True, kw_only=True):
    """Return what an entry was after one of its changes; fails where it was deleted by it, or never was."""

    kind: str
    name: str
    revision: int


class EntryList(Message, frozen=True, kw_only=True):
    """The entries that matched, without their values."""

    entries: tuple[tuple[str, str, int], ...] = msgspec.field(default=())


class ListEntries(Service[EntryList], frozen=True, kw_only=True):
    """List (kind, name, revision) of the entries of `kind` (all kinds when empty) under `prefix`.

    With `tags` only those that have all of them, with `text` those where each of its words begins a
    word of the name or of a tag.
    """

    kind: str = ""
    prefix: str = ""
    tags: tuple[str, ...] = ()
    text: str = ""
