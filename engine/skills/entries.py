"""Named entries over the bus, served under `store` (RCY 2.2)."""

from __future__ import annotations

import msgspec

from engine.messages import Message
from engine.skill import Service


class EntryRecord(Message, frozen=True, kw_only=True, omit_defaults=True):
    """A stored entry: `value` has the fields of its `kind`; `revision` counts its changes.

    `tags` is None when unspecified.
    """

    kind: str
    name: str
    value: dict[str, object]
    revision: int
    tags: tuple[str, ...] | None = None


class ReadEntry(Service[EntryRecord], frozen=True, kw_only=True):
    """Return the entry `name` of `kind`; fails with similar names when there is none."""

    kind: str
    name: str


class WriteEntry(Service[EntryRecord], frozen=True, kw_only=True):
    """Write an entry; with `expected_revision`, only when the stored entry has that revision.

    `tags` replace the present ones, None keeps them. `by` and `reason` are the author and the reason in its history.
    """

    kind: str
    name: str
    value: dict[str, object]
    expected_revision: int | None = None
    tags: tuple[str, ...] | None = None
    by: str = ""
    reason: str = ""


class EntryChanged(Message, frozen=True, kw_only=True):
    """One change of an entry: author, time (UTC, milliseconds since 1970), reason; published on `store/changes`."""

    kind: str
    name: str
    revision: int
    deleted: bool
    tags: tuple[str, ...] = ()
    by: str = ""
    reason: str = ""
    changed_unix_ms: int = 0


class EntryChangeRequest(msgspec.Struct, frozen=True, kw_only=True):
    """The entry to be changed; `expected_revision`, `by` and `reason` are as in `WriteEntry`."""

    kind: str
    name: str
    expected_revision: int | None = None
    by: str = ""
    reason: str = ""


class DeleteEntry(EntryChangeRequest, Service[EntryChanged], frozen=True, kw_only=True):
    """Delete an entry; its history is kept, and `undo_entry` restores it."""


class UndoEntry(EntryChangeRequest, Service[EntryChanged], frozen=True, kw_only=True):
    """Restore an entry as it was before its last change; each further undo goes one change back."""


class EntryHistory(Message, frozen=True, kw_only=True):
    """Every change of an entry, oldest first."""

    changes: tuple[EntryChanged, ...] = ()


class ReadHistory(Service[EntryHistory], frozen=True, kw_only=True):
    """Return every change of an entry; empty when it never existed."""

    kind: str
    name: str


class ReadRevision(Service[EntryRecord], frozen=True, kw_only=True):
    """Return an entry at one of its revisions; fails when that revision deleted it or does not exist."""

    kind: str
    name: str
    revision: int


class EntryList(Message, frozen=True, kw_only=True):
    """The matching entries without their values."""

    entries: tuple[tuple[str, str, int], ...] = msgspec.field(default=())


class ListEntries(Service[EntryList], frozen=True, kw_only=True):
    """List (kind, name, revision) of the entries of `kind` (all kinds when empty) under `prefix`.

    With `tags`, only entries with all of them; with `text`, only entries where each of its words is the
    beginning of a word of the name or of a tag.
    """

    kind: str = ""
    prefix: str = ""
    tags: tuple[str, ...] = ()
    text: str = ""
